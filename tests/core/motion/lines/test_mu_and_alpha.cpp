#include "core/motion/lines/mu_and_alpha.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/motion/lines/line_fit.h"
#include "tests/catch.h"
#include "tests/core/notes.h"

using namespace glidelab;
using namespace glidelab::core;

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kG = 9.81;

LineFit line(int direction, double k, double a0) {
  LineFit fit;
  fit.direction = direction;
  fit.points = 20;
  fit.k_over_m_1_s.value = k;
  fit.a0_m_s2.value = a0;
  fit.parts.var_k = 1e-4;
  fit.parts.var_a0 = 1e-6;
  fit.parts.degrees = std::numeric_limits<double>::infinity();
  complete_line(fit);
  return fit;
}

}  // namespace

TEST_CASE("mu and alpha solve the law of both directions at v = 0, in each place's gravity") {
  for (const double alpha_deg : {-3.0, 0.0, 4.3, 60.0}) {
    for (const double mu : {0.0071, 0.3}) {
      const double down = kG * std::sin(alpha_deg / kDegrees), friction = mu * kG * std::cos(alpha_deg / kDegrees);
      const MuAndAlpha found =
          mu_and_alpha_of_intercepts(line(-1, 2.8, down + friction), line(1, 2.8, down - friction), {kG, 0.0});
      REQUIRE(found.mu.estimate);
      REQUIRE(found.alpha_deg.estimate);
      // Exact but for rounding; the smallest mu is a difference of numbers that are 300 times as large.
      CHECK(found.alpha_deg.estimate->value == Approx(alpha_deg).epsilon(1e-12).margin(1e-12));
      CHECK(found.mu.estimate->value == Approx(mu).epsilon(1e-10));
    }
  }
}

TEST_CASE("where the mean of both intercepts is beyond gravity, neither mu nor alpha is given, for that reason") {
  const MuAndAlpha none = mu_and_alpha_of_intercepts(line(-1, 2.0, 11.0), line(1, 2.0, 10.0), {kG, 0.0});
  for (const Quantity* quantity : {&none.mu, &none.alpha_deg}) {
    CHECK_FALSE(quantity->estimate);
    const auto* const why = tests::reason_of<unknown::MeanBeyondGravity>(*quantity);
    REQUIRE(why != nullptr);
    CHECK(why->mean_m_s2 == Approx(10.5).epsilon(1e-12));
  }
}

TEST_CASE("slopes that disagree make mu and alpha as uncertain as what they leave unexplained moves the intercepts") {
  // The points of both lines have the mean speed 1.5 m/s, so that a slope that is off by d moves its intercept by
  // 1.5 d, uphill and downhill with opposite signs.
  const auto with_mean_speed = [](LineFit of) {
    of.parts.var_a0 = 1.5 * 1.5 * of.parts.var_k + 1e-8;
    of.parts.cov = of.direction * 1.5 * of.parts.var_k;
    complete_line(of);
    return of;
  };
  const double level = 0.02 * kG;  // mu
  const auto found_with = [&](double apart) {
    return mu_and_alpha_of_intercepts(with_mean_speed(line(-1, 2.0 + 0.5 * apart, level)),
                                      with_mean_speed(line(1, 2.0 - 0.5 * apart, -level)), {kG, 0.0});
  };
  const double noise2 = 0.5 * (1.5 * 1.5 * 1e-4 + 1e-8) / (kG * kG);
  const MuAndAlpha agree = found_with(0.02), disagree = found_with(0.2);
  CHECK(agree.mu.estimate->sd == Approx(std::sqrt(noise2)).epsilon(1e-6));
  // Each slope has (0.2² - 2 var_k) / 2 unexplained, but for what counts as rounding (1e-4 of the variances).
  const double slopes2 = 0.5 * 1.5 * 1.5 * 0.5 * (0.04 - 2e-4) / (kG * kG);
  CHECK(disagree.mu.estimate->sd == Approx(std::sqrt(noise2 + slopes2)).epsilon(1e-4));
  CHECK(disagree.alpha_deg.estimate->sd == Approx(std::sqrt(noise2 + slopes2) * kDegrees).epsilon(1e-3));
  CHECK(disagree.mu.estimate->value == Approx(agree.mu.estimate->value).epsilon(1e-12));
}
