#include "validate/study/coverage/interval_coverage.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/truth/binomial.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

/// The first mass of the paper's inclined track: one clip up, which turns, and one down.
render::Scenario one_mass() {
  render::Scenario scenario = render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/paper/inclined.toml");
  scenario.motion.configurations.resize(1);
  return scenario;
}

const CoverageRow& row_of(const Coverage& coverage, const std::string& estimator, const std::string& quantity) {
  return *std::find_if(coverage.rows.begin(), coverage.rows.end(),
                       [&](const CoverageRow& row) { return row.estimator == estimator && row.quantity == quantity; });
}

}  // namespace

TEST_CASE("intervals of the estimators hold the truth in most of 60 replicates, those of the naive lines do not") {
  const Coverage coverage = measure_coverage(one_mass(), {.replicates = 60, .noise_sd_m = 5e-5, .seed = 3, .jobs = 2});
  REQUIRE(coverage.rows.size() == 16);
  for (const char* quantity : {"k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s"}) {
    INFO(quantity);
    const CoverageRow& lines = row_of(coverage, "phase-diagram", quantity);
    const CoverageRow& whole = row_of(coverage, "trajectory", quantity);
    CHECK(lines.determined == 60);
    CHECK(whole.determined == 60);
    // Of 60 intervals of 95 % fewer than 50 hold the truth once in 20,000.
    CHECK(lines.covered >= 50);
    CHECK(whole.covered >= 50);
    REQUIRE((lines.efficiency && whole.efficiency));
    // A variance of 60 values is known to 18 %; three of these below 1.
    CHECK(*whole.efficiency > 0.55);
    CHECK(*whole.efficiency < 1.9);
    CHECK(*lines.efficiency < *whole.efficiency);
    // Nominal within the binomial tails of 1 in 20,000 at every level, each interval within the next.
    REQUIRE(whole.levels.size() == 5);
    std::size_t before = 0;
    for (const LevelCount& at : whole.levels) {
      INFO(at.level);
      CHECK(at.p_value > 1e-4);
      CHECK(at.covered >= before);
      before = at.covered;
      if (at.level == 0.95) CHECK(at.covered == whole.covered);
    }
  }
  // Smoothed neighbours are not independent: a textbook interval of the slope is several times too short.
  CHECK(row_of(coverage, "naive-lines", "k_over_m_1_s").covered < 50);
}

TEST_CASE("coverage is the same for any number of jobs, and another for another seed") {
  const CoverageOptions options{.replicates = 4, .noise_sd_m = 5e-5, .seed = 3, .jobs = 1};
  const Coverage one = measure_coverage(one_mass(), options);
  CoverageOptions again = options;
  again.jobs = 3;
  CHECK(row_of(measure_coverage(one_mass(), again), "trajectory", "mu").bias == row_of(one, "trajectory", "mu").bias);
  again.seed = 1000;
  CHECK(row_of(measure_coverage(one_mass(), again), "trajectory", "mu").bias != row_of(one, "trajectory", "mu").bias);
}

TEST_CASE("without a noise each clip has the least that the scenario's camera allows, and other clocks make no bias") {
  const Coverage coverage = measure_coverage(one_mass(), {.replicates = 20, .seed = 3, .jobs = 2});
  CHECK(coverage.camera_noise);
  REQUIRE(coverage.noise_sd_m.size() == 2);
  for (const double sd : coverage.noise_sd_m) {
    CHECK(sd > 5e-7);  // a two-thousandth of a pixel, which is 2 mm: no image of 8 bits is so good
    CHECK(sd < 5e-5);  // a fortieth of one
  }
  const CoverageRow& k = row_of(coverage, "trajectory", "k_over_m_1_s");
  CHECK(std::abs(k.bias) < 4.0 * k.sd / std::sqrt(20.0));
  CHECK(k.covered >= 15);  // of 20 intervals of 95 % fewer than 15 hold the truth once in 3000
}

TEST_CASE("a noise or a number of replicates of nothing is refused") {
  CHECK_THROWS_AS(measure_coverage(one_mass(), {.replicates = 4, .noise_sd_m = 0.0}), base::InputError);
  CHECK_THROWS_AS(measure_coverage(one_mass(), {.replicates = 0, .noise_sd_m = 1e-5}), base::InputError);
}

TEST_CASE("an interval's arms at another level are those of the normal, or of t with the interval's degrees") {
  // t of 3 degrees: 3.182446 at 0.975, 0.764892 at 0.75, 5.840909 at 0.995 (tables); 1.959964, 0.674490, 2.575829.
  CHECK(arm_ratio(0.5, 3.182446305, 1.0) == Approx(0.764892 / 3.182446).epsilon(1e-5));
  CHECK(arm_ratio(0.99, 3.182446305, 1.0) == Approx(5.840909 / 3.182446).epsilon(1e-5));
  CHECK(arm_ratio(0.5, 2.0 * 1.959963985, 2.0) == Approx(0.674490 / 1.959964).epsilon(1e-5));
  CHECK(arm_ratio(0.99, 1.959963985, 1.0) == Approx(2.575829 / 1.959964).epsilon(1e-5));
  CHECK(arm_ratio(0.95, 2.2, 1.0) == Approx(1.0).epsilon(1e-12));
}

TEST_CASE("the band of chance holds at least 95 % of a binomial's counts, and less with one fewer at either end") {
  for (const std::size_t n : {20u, 200u}) {
    for (const double level : {0.5, 0.95}) {
      const CoverageBand band = band_of(level, n);
      const long low = std::lround(band.low * static_cast<double>(n));
      const long high = std::lround(band.high * static_cast<double>(n));
      CHECK(binomial_cdf(high, n, level) - binomial_cdf(low - 1, n, level) >= 0.95);
      CHECK(binomial_cdf(high - 1, n, level) < 0.975);
      CHECK(binomial_cdf(low, n, level) >= 0.025);
    }
  }
}

TEST_CASE("a level out of bounds or twice is refused") {
  CHECK_THROWS_AS(measure_coverage(one_mass(), {.replicates = 4, .noise_sd_m = 1e-5, .levels = {0.5, 1.0}}),
                  base::InputError);
  CHECK_THROWS_AS(measure_coverage(one_mass(), {.replicates = 4, .noise_sd_m = 1e-5, .levels = {0.5, 0.5}}),
                  base::InputError);
}

TEST_CASE("rows fail where a level's count is far from it, not where it is near, and never for the naive lines") {
  Coverage coverage;
  coverage.levels = {0.5, 0.95};
  const auto row = [](const char* estimator, double p50, double p95, double coverage95) {
    CoverageRow of;
    of.estimator = estimator;
    of.determined = 1000;
    of.levels = {{0.5, 450, 0.45, 0.0, 1.0, p50}, {0.95, 0, coverage95, 0.0, 1.0, p95}};
    return of;
  };
  // Six tests of estimators: 1 % over six is 0.0017.
  coverage.rows = {row("trajectory", 1e-3, 0.5, 0.94), row("phase-diagram", 0.0018, 0.5, 0.94),
                   row("naive-lines", 0.0, 0.0, 0.6), row("phase-diagram-gls", 0.5, 1e-6, 1.0)};
  const auto narrow = too_narrow(coverage), wide = too_wide(coverage);
  REQUIRE(narrow.size() == 1);
  CHECK(narrow[0].row.estimator == "trajectory");
  CHECK(narrow[0].at.level == 0.5);
  REQUIRE(wide.size() == 1);
  CHECK(wide[0].row.estimator == "phase-diagram-gls");
  CHECK(wide[0].at.level == 0.95);
}

TEST_CASE("an outside estimator is counted beside the others, with the runs that failed") {
  // It answers K/m alone, with an interval that holds every truth.
  const tests::TempDir temp;
  base::write_file(
      temp / "mine.sh",
      R"(echo '{"format": 1, "configurations": [{"clips": ["m1-up", "m1-down"], "k_over_m_1_s": {"value": 3, "sd": 5},
 "mu": null, "alpha_deg": null, "v_lim_m_s": null}]}' > "$2/results.json")");
  CoverageOptions options{.replicates = 3, .noise_sd_m = 5e-5, .seed = 3, .jobs = 2};
  options.outside = fit::outside_estimator("sh " + (temp / "mine.sh").string() + " {folder} {out}");
  const Coverage coverage = measure_coverage(one_mass(), options);
  REQUIRE(coverage.rows.size() == 20);
  CHECK(row_of(coverage, "mine", "k_over_m_1_s").determined == 3);
  CHECK(row_of(coverage, "mine", "k_over_m_1_s").covered == 3);
  CHECK(row_of(coverage, "mine", "k_over_m_1_s").stated_sd == Approx(5.0).epsilon(1e-12));
  CHECK(row_of(coverage, "mine", "mu").determined == 0);
  REQUIRE(coverage.outside);
  CHECK(coverage.outside->runs == 3);
  CHECK(coverage.outside->failed() == 0);

  options.outside = fit::outside_estimator("sh -c 'exit 3' mine {folder} {out}");
  const Coverage failed = measure_coverage(one_mass(), options);
  CHECK(failed.outside->failures[0].count == 3);
  CHECK(failed.outside->failures[0].first == "exit status 3");
  CHECK(row_of(failed, "mine", "k_over_m_1_s").determined == 0);
  // The others are what they are without it.
  CHECK(row_of(failed, "trajectory", "mu").bias == row_of(coverage, "trajectory", "mu").bias);
}
