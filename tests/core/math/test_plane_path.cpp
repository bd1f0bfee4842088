#include "core/math/plane_path.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr int kMany = 160;

/// A path of 1 m at 20 degrees to the x axis, with `across` its deviation from that line.
core::PlanePath path_with(const std::function<double(double)>& across, double noise_m = 0.0) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const double c = std::cos(20.0 / 57.29577951308232), s = std::sin(20.0 / 57.29577951308232);
  core::PlanePath path;
  for (int i = 0; i < kMany; ++i) {
    const double along = static_cast<double>(i) / (kMany - 1), off = across(along) + noise_m * normal(random);
    path.x_m.push_back(c * along - s * off);
    path.y_m.push_back(s * along + c * off);
  }
  return path;
}

}  // namespace

TEST_CASE("a straight path has the angle of its line and no bend beyond its noise") {
  const core::PlanePath straight = path_with([](double) { return 0.0; }, 1e-3);
  CHECK(core::slant_deg(straight) == Approx(20.0).margin(0.1));  // 1 mm of noise in 160 positions over a metre
  CHECK(core::sagitta_of(straight) == 0.0);
  const core::PathBend bend = core::bend_of(straight);
  CHECK(bend.length_m == Approx(1.0).margin(5e-3));
  CHECK(bend.noise_m == Approx(1e-3).epsilon(0.25));  // a median of 158 magnitudes, which overlap: 10 %
  // Medians of ten have 0.37 of the noise, and sixteen of them a range of some 3.5 of that.
  CHECK(bend.range_m < 2.5e-3);
  CHECK(bend.slope_deg < 1.0);  // 0.4 mm at either end of an eighth of a metre: 0.26 degrees, with a range of 3.5 of it
}

TEST_CASE("an arc has the range of its sagitta, and the direction of its ends as bend") {
  // h (1 - (2 s - 1)²) has the sagitta h and the slope 4 h (1 - 2 s); the outermost parts have their middles at 3/32
  // and 29/32, with ±3.25 h.
  const core::PathBend bend = core::bend_of(path_with([](double s) { return 0.03 * 4.0 * s * (1.0 - s); }, 2e-4));
  // The middles of the first and the last of sixteen groups are a thirty-second from the ends: (1 - 1/16)² = 0.88.
  CHECK(bend.range_m == Approx(0.88 * 0.03).epsilon(0.05));
  CHECK(bend.slope_deg == Approx(2.0 * std::atan(3.25 * 0.03) * 57.29577951308232).epsilon(0.1));
}

TEST_CASE("a wave is a bend although no arc describes it, and single wrong positions are none") {
  const auto wave = [](double s) { return 0.05 * std::sin(4.0 * std::numbers::pi * s); };
  CHECK(core::sagitta_of(path_with(wave)) < 0.08);
  CHECK(core::bend_of(path_with(wave)).range_m == Approx(0.1).epsilon(0.1));  // sixteen medians of two periods
  core::PlanePath wrong = path_with([](double) { return 0.0; }, 1e-4);
  for (const std::size_t i : {20, 80, 140}) wrong.y_m[i] += 0.3;
  CHECK(core::bend_of(wrong).range_m < 0.01);  // the line through all turns a little
}

TEST_CASE("a staircase of rounded coordinates is told by its step") {
  core::PlanePath path = path_with([](double) { return 0.0; });
  for (double& y : path.y_m) y = 1e-3 * std::round(0.02 / 1e-3 * y);  // 0.4 degrees, in millimetres
  const core::PathBend bend = core::bend_of(path);
  CHECK(bend.step_m == Approx(1e-3).epsilon(1e-9));
  CHECK(bend.range_m < 2.0 * bend.step_m);
}

TEST_CASE("a bounce that drifts sideways is no bend of a track") {
  // From 1 m, three times to 0.9 m after 0.9 s each, with a drift of 6 cm/s across.
  core::PlanePath path;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.0135 * i, of_arc = std::fmod(t, 0.9) - 0.45;
    path.x_m.push_back(0.06 * t);
    path.y_m.push_back(0.9 - 0.5 * 9.81 * of_arc * of_arc);
  }
  const core::PathBend bend = core::bend_of(path);
  CHECK(bend.range_m < 0.08 * bend.length_m);  // in the order of time it is 0.1 of it
}

TEST_CASE("a body at rest has no path") {
  core::PlanePath path;
  path.x_m.assign(20, 0.3);
  path.y_m.assign(20, 0.1);
  const core::PathBend bend = core::bend_of(path);
  CHECK(bend.length_m == 0.0);
  CHECK(bend.range_m == 0.0);
  CHECK(bend.slope_deg == 0.0);
}
