#include "core/motion/lines/line_law.h"

#include <random>

#include "core/motion/lines/line_fit.h"
#include "tests/catch.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using namespace glidelab::core;

namespace {

constexpr double kStep = 0.005;

LineInput smoothed(const std::vector<double>& x, double bandwidth_s) {
  Motion motion;
  for (std::size_t i = 0; i < x.size(); ++i) {
    motion.t_s.push_back(static_cast<double>(i) * kStep);
    motion.point.push_back(i);
  }
  motion.x_m = motion.y_m = x;
  motion.step_s = kStep;
  const auto points = smooth_stretches(
      motion, {{0, x.size(), 1, LeftOut::kernel_end, LeftOut::kernel_end, LeftOut::used}}, bandwidth_s);
  return line_input(motion, points, std::vector<double>(points.size(), 0.0), 1, 1.0, 0.0);
}

std::vector<double> positions(const tests::Law& law, std::size_t count) {
  const auto motion = tests::launch(law, 1.2, kStep * static_cast<double>(count));
  std::vector<double> x;
  for (std::size_t i = 0; i < count; ++i) x.push_back(motion.x(kStep * static_cast<double>(i)));
  return x;
}

std::vector<double> noisy(std::vector<double> x, double noise_m, std::mt19937_64& random) {
  std::normal_distribution<double> deviate(0.0, noise_m);
  for (double& value : x) value += deviate(random);
  return x;
}

const tests::Law kLaw{4.0, 0.006, 2.0};

}  // namespace

TEST_CASE("a line through smoothed noise-free positions less its law's bias is the law") {
  for (const double bandwidth_s : {0.03, 0.06, 0.1}) {
    INFO(bandwidth_s);
    const LineInput input = smoothed(positions(kLaw, 300), bandwidth_s);
    const std::vector<double> noise{1e-20};
    auto line = fit_line(1, input, noise, 0.0, Misfit::ignored);
    REQUIRE(line);
    line->parts.law = law_bias(input, *line, noise);
    REQUIRE(line->parts.law);
    CHECK(line->k_over_m_1_s.value - kLaw.k_1_s > 0.4 * std::pow(kLaw.k_1_s, 3) * bandwidth_s * bandwidth_s);
    const LineFit straight = without_law_bias(*line);
    // Rounding of x (1e-16) over h^2 makes 1e-13 of a; the fixed point is settled to 1e-12. Six digits to spare.
    CHECK(std::abs(straight.k_over_m_1_s.value - kLaw.k_1_s) < 1e-6);
    CHECK(std::abs(straight.a0_m_s2.value - kLaw.a0(1)) < 1e-6);
    CHECK_FALSE(straight.parts.law);
  }
}

TEST_CASE("lines of 300 noisy replicates without their bias scatter about the law as they state") {
  constexpr double kNoise = 2e-4;
  const std::vector<double> x = positions(kLaw, 300), noise{kNoise * kNoise};
  std::mt19937_64 random(7);
  double sum = 0.0, squares = 0.0, stated = 0.0, as_fitted = 0.0, n = 0.0;
  for (int replicate = 0; replicate < 300; ++replicate) {
    const LineInput input = smoothed(noisy(x, kNoise, random), 0.08);
    auto line = fit_line(1, input, noise, 0.0);
    REQUIRE(line);
    as_fitted += line->k_over_m_1_s.value - kLaw.k_1_s;
    line->parts.law = law_bias(input, *line, noise);
    if (!line->parts.law) continue;  // the points scatter by chance
    const LineFit straight = without_law_bias(*line);
    const double error = straight.k_over_m_1_s.value - kLaw.k_1_s;
    sum += error;
    squares += error * error;
    stated += std::pow(straight.k_over_m_1_s.sd, 2);
    n += 1.0;
  }
  CHECK(n > 290.0);  // one in a hundred at most is off by three standard deviations
  const double sd = std::sqrt(squares / n);
  CHECK(std::abs(sum / n) < 4.0 * sd / std::sqrt(n));
  CHECK(as_fitted / 300.0 > 4.0 * sd / std::sqrt(300.0));  // and with it, the lines are wrong
  // The standard deviation of 300 values is known to 4.1 %; three of these.
  CHECK(std::abs(sd / std::sqrt(stated / n) - 1.0) < 0.13);
}

TEST_CASE(
    "nothing is taken off where the law does not hold, where the bias is as large as the value, or with a force") {
  std::vector<double> x;  // v' = -3 v^2: x = ln(1 + 3 v0 t) / 3
  for (int i = 0; i < 300; ++i) x.push_back(std::log1p(3.0 * 1.2 * kStep * i) / 3.0);
  const std::vector<double> noise{1e-12};
  std::mt19937_64 random(1);
  const LineInput quadratic = smoothed(noisy(x, 1e-6, random), 0.04);
  const auto bent = fit_line(1, quadratic, noise, 0.0);
  REQUIRE(bent);
  CHECK_FALSE(law_bias(quadratic, *bent, noise));

  const LineInput wide = smoothed(positions({4.0, 0.006, 6.0}, 300), 0.25);  // (k h)^2 / 2 = 1.1
  const auto coarse = fit_line(1, wide, noise, 0.0, Misfit::ignored);
  REQUIRE(coarse);
  CHECK_FALSE(law_bias(wide, *coarse, noise));

  LineInput forced = smoothed(positions(kLaw, 300), 0.04);
  forced.forced = true;
  const auto line = fit_line(1, forced, noise, 0.0, Misfit::ignored);
  REQUIRE(line);
  CHECK_FALSE(law_bias(forced, *line, noise));
}
