#include "validate/study/baseline/baseline_comparison.h"

#include <cmath>
#include <random>

#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

constexpr std::size_t kRuns = 80;

/// A baseline of one quantity whose errors are `factor` z + `bias`, z standard normal.
Baseline drawn(std::mt19937_64& engine, double factor, double bias) {
  std::normal_distribution<double> normal;
  std::vector<double> errors(kRuns);
  for (double& error : errors) error = factor * normal(engine) + bias;
  ErrorRecord record{"m1", "trajectory", "mu", kRuns, kRuns, kRuns, 0.0, 0.0, 0.0, 0.0, 0.0};
  const auto n = static_cast<double>(kRuns);
  for (const double error : errors) record.mean += error / n;
  for (const double error : errors) {
    record.sd += (error - record.mean) * (error - record.mean) / (n - 1.0);
    record.deviation += std::abs(error - record.mean) / n;
  }
  for (const double error : errors) {
    record.deviation_sd += std::pow(std::abs(error - record.mean) - record.deviation, 2) / (n - 1.0);
  }
  record.sd = std::sqrt(record.sd);
  record.deviation_sd = std::sqrt(record.deviation_sd);
  Baseline baseline{"text", 1e-5, kRuns, {}, {record}, {}};
  return baseline;
}

/// A baseline with the moments of normal errors themselves.
Baseline ideal() {
  Baseline baseline{"text", 1e-5, kRuns, {}, {}, {}};
  baseline.records = {{"m1", "trajectory", "mu", kRuns, kRuns, kRuns, 0.0, 1.0, std::sqrt(2.0 / M_PI),
                       std::sqrt(1.0 - 2.0 / M_PI), 0.0}};
  return baseline;
}

bool finds(const Baseline& then, const Baseline& now, const std::string& what) {
  for (const Worse& worse : compare_baselines(then, now).worse) {
    if (worse.what == what) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("The least worsening that a gate says it finds nine times in ten is found nine times in ten") {
  const Baseline like = ideal();
  const std::vector<Detectable> all = detectable(like, like, compare_baselines(like, like));
  REQUIRE(all.size() == 1);
  REQUIRE((all[0].factor && all[0].bias));
  CHECK(*all[0].factor > 1.2);
  // By the tests themselves on drawn errors. 400 draws know 0.9 to 0.015; z in place of t of 80 values moves it by 0.01
  // and the skewed |error| by some more: 0.06 in all. Drawn without a change it is never found.
  std::mt19937_64 engine(7);
  int larger = 0, farther = 0, unchanged = 0;
  constexpr int kDraws = 400;
  for (int i = 0; i < kDraws; ++i) {
    const Baseline then = drawn(engine, 1.0, 0.0);
    larger += finds(then, drawn(engine, *all[0].factor, 0.0), "spread") ? 1 : 0;
    // From a mean of its own: |mean| is then as much farther off as the mean.
    const Baseline aside = drawn(engine, 1.0, 3.0);
    farther += finds(aside, drawn(engine, 1.0, 3.0 + *all[0].bias), "bias") ? 1 : 0;
    unchanged += finds(then, drawn(engine, 1.0, 0.0), "spread") ? 1 : 0;
  }
  CHECK(std::abs(larger / static_cast<double>(kDraws) - 0.9) < 0.06);
  CHECK(std::abs(farther / static_cast<double>(kDraws) - 0.9) < 0.06);
  CHECK(unchanged <= 6);
}

TEST_CASE("A gate of few runs is weak, and says with how many it would not be") {
  const auto of = [](std::uint64_t runs) {
    Baseline baseline = ideal();
    baseline.runs = runs;
    ErrorRecord& record = baseline.records[0];
    record.runs = record.answers = record.covered = runs;
    return detectable(baseline, baseline, compare_baselines(baseline, baseline)).at(0);
  };
  const Detectable few = of(30);
  CHECK(few.weak());
  CHECK(few.runs_for_weak > 30);
  const Detectable enough = of(few.runs_for_weak);
  CHECK_FALSE(enough.weak());
  CHECK(*enough.factor == Approx(kWeakFactor).epsilon(0.01));  // the next whole number of runs
  CHECK_FALSE(of(4).factor);                                   // no factor is large enough
}
