#include "validate/study/certify/certificate.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/catch.h"
#include "validate/truth/binomial.h"

using namespace glidelab::validate;

TEST_CASE("a share of runs with one value each has the interval of Clopper and Pearson") {
  std::vector<RunCount> runs(40, {1, 1});
  runs[3].holds = runs[20].holds = 0;
  const RunShare share = share_of(runs, 0.95);
  const ProportionInterval exact = proportion_interval(38, 40, 0.95);
  CHECK(share.share == 38.0 / 40.0);
  // The share of single runs scatters by p (1 - p) / (n - 1) by the jackknife: 39 independent values of 40, which
  // moves the ends by less than one part in 39 of their distance from the share.
  CHECK(std::abs(share.low - exact.low) < (share.share - exact.low) / 39.0);
  CHECK(std::abs(share.high - exact.high) < (exact.high - share.share) / 39.0);
}

TEST_CASE("values of one run that hold or fail together count once") {
  std::vector<RunCount> runs(40, {12, 12});
  for (std::size_t r = 0; r < 4; ++r) runs[r * 7].holds = 0;
  const RunShare share = share_of(runs, 0.95);
  const ProportionInterval of_runs = proportion_interval(36, 40, 0.95), of_values = proportion_interval(432, 480, 0.95);
  CHECK(std::abs(share.low - of_runs.low) < 0.01);
  CHECK(std::abs(share.high - of_runs.high) < 0.01);
  CHECK(share.low < of_values.low - 0.05);
}

TEST_CASE("a share without failures is judged by the number of runs, and of nothing there is none") {
  const RunShare all = share_of(std::vector<RunCount>(30, {4, 4}), 0.95);
  CHECK(all.high == 1.0);
  // Clopper and Pearson of n of n: low = (alpha / 2)^(1 / n).
  CHECK(std::abs(all.low - std::pow(0.025, 1.0 / 30.0)) < 1e-9);
  const RunShare none = share_of({{0, 0}, {0, 0}}, 0.95);
  CHECK(none.of == 0);
  CHECK(none.low == 0.0);
  CHECK(none.high == 1.0);
}

TEST_CASE("the interval of a share over runs holds it as often as it says, with what runs have in common") {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> uniform;
  int held = 0;
  constexpr int kTrials = 400;
  constexpr double kBad = 0.06;  // runs whose values hold by half only; else by 0.97
  const double truth = kBad * 0.5 + (1.0 - kBad) * 0.97;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<RunCount> runs(40);
    for (RunCount& run : runs) {
      const double p = uniform(engine) < kBad ? 0.5 : 0.97;
      for (int i = 0; i < 12; ++i) {
        ++run.of;
        if (uniform(engine) < p) ++run.holds;
      }
    }
    const RunShare share = share_of(runs, 0.95);
    held += share.low <= truth && truth <= share.high ? 1 : 0;
  }
  // The interval is conservative by its construction and approximate in D: at least 92 % less 3 sd of 400 trials.
  CHECK(held >= 0.88 * kTrials);
}

TEST_CASE("the mean over runs and its deviation are those of the textbook where each run has one value") {
  const std::vector<double> values = {1.0, 4.0, 2.0, 7.0};
  const RunMean mean = mean_of(values, std::vector<double>(4, 1.0));
  CHECK(std::abs(mean.value - 3.5) < 1e-12);
  CHECK(std::abs(mean.sd - std::sqrt(21.0 / 3.0 / 4.0)) < 1e-12);  // sqrt(sum of squares / (n - 1) / n)
}

TEST_CASE("errors that are half as large in every run fall by a half for sure, independent ones by nothing for sure") {
  std::mt19937_64 engine(9);
  std::normal_distribution<double> deviate;
  std::vector<double> before, half, other;
  for (int r = 0; r < 40; ++r) {
    before.push_back(std::pow(deviate(engine), 2));
    half.push_back(0.25 * before.back());
    other.push_back(std::pow(deviate(engine), 2));
  }
  const RunFall sure = fall_of({before}, {half}, 0.95);
  CHECK(std::abs(sure.value - 0.5) < 1e-12);
  CHECK(std::abs(sure.low - 0.5) < 1e-9);
  CHECK(std::abs(sure.high - 0.5) < 1e-9);
  const RunFall chance = fall_of({before}, {other}, 0.95);
  CHECK(chance.low < 0.0);
  CHECK(chance.high > 0.0);
  // ln of a ratio of root mean squares of 40 normal numbers each: sd sqrt(2 / (2 * 40)) = 0.16, so the interval is
  // 2 * 2.02 * 0.16 = 0.64 wide in the logarithm; the jackknife of 40 knows that to a third.
  const double width = std::log((1.0 - chance.low) / (1.0 - chance.high));
  CHECK(width > 0.4);
  CHECK(width < 0.95);
  const RunFall both = fall_of({before, before}, {half, before}, 0.95);
  CHECK(std::abs(both.value - (1.0 - std::sqrt(0.5))) < 1e-12);
}
