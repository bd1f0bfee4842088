#include "validate/study/requirement/target.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/catch.h"
#include "validate/study/requirement/candidate.h"

using namespace glidelab;
using validate::Target;

namespace {

validate::ErrorMeasure measured(const std::vector<double>& errors, Target::Measure measure, double target = 0.0005) {
  return validate::measure_errors(errors, {"mu", measure, target});
}

std::vector<double> normal(int n, double mean, double sd, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> draw(mean, sd);
  std::vector<double> errors(static_cast<std::size_t>(n));
  for (double& error : errors) error = draw(random);
  return errors;
}

}  // namespace

TEST_CASE("the +- of a root mean square error is right where one run in a hundred is far off") {
  // k of n errors are a, the others 0: rms = a sqrt(k/n), and of a resample a sqrt(K/n) with K binomial (n, k/n).
  constexpr int kRuns = 200, kFar = 3;
  constexpr double kSize = 0.001;
  std::vector<double> errors(kRuns, 0.0);
  for (const std::size_t run : {17u, 60u, 141u}) errors[run] = kSize;
  const validate::ErrorMeasure found = measured(errors, Target::Measure::sd);
  const double p = static_cast<double>(kFar) / kRuns;
  double mean = 0.0, square = 0.0, part = std::pow(1.0 - p, kRuns);
  for (int k = 0; k <= kRuns; ++k) {
    mean += part * kSize * std::sqrt(static_cast<double>(k) / kRuns);
    square += part * kSize * kSize * k / kRuns;
    part *= p / (1.0 - p) * (kRuns - k) / (k + 1.0);
  }
  const double sd = std::sqrt((square - mean * mean) * kRuns / (kRuns - 1.0));
  CHECK(found.value == Approx(kSize * std::sqrt(p)).epsilon(1e-12));
  // 1000 resamples: the sd of a sd is 1/sqrt(2000) = 2.2 % of a normal one; four of it.
  CHECK(std::abs(found.sd / sd - 1.0) < 4.0 / std::sqrt(2.0 * validate::kResamples));
  CHECK(found.sd > 4.0 * found.value / std::sqrt(2.0 * kRuns));  // what normal errors would have
  CHECK(found.runs == 200);
  CHECK(found.beyond == 3);
}

TEST_CASE("the +- of normal errors is that of the normal distribution") {
  // rms / sqrt(2 n); from n errors it is known to about sqrt(10.7 / n) / 2 = 12 %: three of it.
  const std::vector<double> errors = normal(200, 0.0, 1e-4, 5);
  const validate::ErrorMeasure rms = measured(errors, Target::Measure::sd);
  CHECK(std::abs(rms.sd / (rms.value / std::sqrt(400.0)) - 1.0) < 0.36);
  const validate::ErrorMeasure bias = measured(errors, Target::Measure::bias);
  CHECK(bias.sd == Approx(1e-4 / std::sqrt(200.0)).epsilon(0.15));  // sd of 200: 5 %, three of it
  CHECK(bias.value < 4.0 * bias.sd);
}

TEST_CASE("sd has the bias in it, bias has not the scatter") {
  const std::vector<double> errors = {3.0, 5.0, 3.0, 5.0};
  CHECK(measured(errors, Target::Measure::sd).value == Approx(std::sqrt(17.0)).epsilon(1e-14));
  CHECK(measured(errors, Target::Measure::bias).value == 4.0);
  CHECK(measured(errors, Target::Measure::bias).sd == Approx(std::sqrt(4.0 / 3.0) / 2.0).epsilon(1e-14));
}

TEST_CASE("the 95 % error is what 95 % of the runs stay within, however far the others are") {
  std::vector<double> errors;
  for (int i = 1; i <= 200; ++i) errors.push_back(i % 2 == 0 ? i : -i);
  CHECK(measured(errors, Target::Measure::error95).value == 190.0);
  for (double& error : errors) error *= std::abs(error) > 190.0 ? 1e9 : 1.0;
  CHECK(measured(errors, Target::Measure::error95, 150.5).value == 190.0);
  CHECK(measured(errors, Target::Measure::error95, 150.5).beyond == 50);
  // Four do not know a quantile: 1.96 times their rms, sqrt(63 / 4).
  CHECK(measured({1.0, -7.0, 2.0, 3.0}, Target::Measure::error95).value == Approx(1.959964 * std::sqrt(15.75)));
}

TEST_CASE("the limits of a 95 % error are sorted errors where these are many") {
  std::vector<double> errors;
  for (int i = 1; i <= 200; ++i) errors.push_back(i);
  // Binomial (200, 0.95), by its table: P(X <= 184) = 0.044 and P(X <= 185) = 0.078, P(X <= 193) = 0.904 and
  // P(X <= 194) = 0.938, P(X <= 195) = 0.966 in steps of one error.
  const validate::ErrorMeasure many = measured(errors, Target::Measure::error95);
  CHECK(many.value == 190.0);
  CHECK(many.low < 190.0);
  CHECK(many.high > 190.0);
  double below_low = 0.0, below_high = 0.0, part = std::pow(0.05, 200);
  for (int k = 0; k < 200; ++k) {  // number of errors below the quantile
    if (k < many.low) below_low += part;
    if (k < many.high) below_high += part;
    part *= 0.95 / 0.05 * (200 - k) / (k + 1.0);
  }
  CHECK(below_low <= 0.05);   // the quantile lies below that error with 5 % at most
  CHECK(below_high >= 0.95);  // and below this one with 95 % at least
  // Of 59 the largest is a limit, and of 58 none would be.
  errors.resize(validate::kRunsForQuantile);
  CHECK(measured(errors, Target::Measure::error95).high == 59.0);
  CHECK(std::pow(0.95, 59) < 0.05);
  CHECK(std::pow(0.95, 58) > 0.05);
}

TEST_CASE("the limits of few errors are those of a normal distribution") {
  // chi² of 4 degrees of freedom: 5 % below 0.711, 5 % above 9.488 (tables).
  const validate::ErrorMeasure few = measured({1.0, -1.0, 1.0, -1.0}, Target::Measure::sd);
  CHECK(few.value == 1.0);
  CHECK(few.high == Approx(std::sqrt(4.0 / 0.711)).epsilon(5e-4));
  CHECK(few.low == Approx(std::sqrt(4.0 / 9.488)).epsilon(5e-4));
  const validate::ErrorMeasure within = measured({1.0, -1.0, 1.0, -1.0}, Target::Measure::error95);
  CHECK(within.high == Approx(1.959964 * few.high));
}

TEST_CASE("a camera judged after every look is wrongly said to reach or to miss in less than one case of twenty") {
  // Errors whose 95 % quantile is the target itself, so that either verdict is wrong: by normal ones, in looks after 2,
  // 4, 8, 16 and 20. Of 4000 at 5 % on either side, a standard deviation of 0.35 % each; three of it.
  constexpr std::uint64_t kMost = 20;
  const std::vector<std::uint64_t> looks = validate::looks(kMost);
  CHECK(looks == std::vector<std::uint64_t>{2, 4, 8, 16, 20});
  CHECK(validate::looks(3) == std::vector<std::uint64_t>{2, 3});
  const double confidence = validate::confidence_of_look(kMost);
  CHECK(confidence == Approx(0.99));
  int reached = 0, missed = 0;
  constexpr int kCases = 4000;
  for (unsigned seed = 0; seed < kCases; ++seed) {
    const std::vector<double> errors = normal(static_cast<int>(kMost), 0.0, 1.0 / 1.959964, seed + 1);
    for (const std::uint64_t look : looks) {
      const validate::ErrorMeasure found =
          validate::measure_errors(std::span(errors).first(look), {"mu", Target::Measure::error95, 1.0}, confidence);
      if (found.high <= 1.0 || found.low > 1.0) {
        ++(found.high <= 1.0 ? reached : missed);
        break;
      }
    }
  }
  CAPTURE(reached, missed);
  CHECK(reached < kCases * 0.06);
  CHECK(missed < kCases * 0.06);
  CHECK(reached + missed > kCases * 0.01);  // and it is not that nothing is ever decided
}

TEST_CASE("a run without an answer is beyond any target") {
  std::vector<double> errors = normal(200, 0.0, 1e-6, 7);
  errors[100] = std::numeric_limits<double>::infinity();
  CHECK(std::isinf(measured(errors, Target::Measure::sd).value));
  CHECK(std::isinf(measured(errors, Target::Measure::bias).value));
  const validate::ErrorMeasure within = measured(errors, Target::Measure::error95);
  CHECK(within.value == Approx(1.96e-6).epsilon(0.3));
  CHECK(std::isfinite(within.sd));  // 11 of them in a resample: never seen
  CHECK(within.beyond == 1);
}

TEST_CASE("of few errors one beyond the target keeps it open, however small the others are, and none changes nothing") {
  std::vector<double> errors = normal(19, 0.0, 1e-5, 11);
  errors.push_back(6e-4);
  // 19 of 20 within: by the binomial distribution up to 21.6 % of all may lie beyond (0.784^20 + 20 0.216 0.784^19 =
  // 5 %), and the limit of normal errors, 1.96 rms sqrt(20 / 10.85) = 0.00036, is below an error that was seen.
  for (const double confidence : {validate::kConfidence, validate::confidence_of_look(20)}) {
    const validate::ErrorMeasure found =
        validate::measure_errors(errors, {"mu", Target::Measure::error95, 5e-4}, confidence);
    CHECK(found.beyond == 1);
    CHECK(found.high >= 6e-4);
    CHECK(found.low <= found.value);
    CHECK(found.value < 5e-4);
  }
  const double rms = std::sqrt((19 * 1e-10 + 36e-8) / 20.0);  // within 3 %: 36e-8 is 190 times the rest
  const validate::ErrorMeasure within = measured(errors, Target::Measure::error95, 7e-4);
  CHECK(within.beyond == 0);
  CHECK(within.high == Approx(1.959964 * rms * std::sqrt(20.0 / 10.851)).epsilon(0.03));  // chi² of 20 at 5 %: tables
  errors.back() = std::numeric_limits<double>::infinity();
  CHECK(std::isinf(measured(errors, Target::Measure::error95, 7e-4).high));
}
