#include "report/analysis/camera_plots.h"

#include <cmath>
#include <numbers>
#include <random>
#include <regex>
#include <string>

#include "tests/catch.h"

using namespace glidelab::report;
using namespace glidelab;

TEST_CASE("the numbers along the calibration's image leave room between them, whatever its width") {
  for (const int width_px : {320, 640, 800, 1280, 1440, 1456, 1920, 3840}) {
    core::CornerMap rests;
    rests.width_px = width_px;
    rests.height_px = width_px * 3 / 4;
    rests.cells = {core::CornerCell{.u_px = 10.0, .v_px = 10.0, .du_px = 0.1, .dv_px = 0.1}};
    const std::vector<report::Plot> plots = report::calibration_plots(rests, "");
    REQUIRE(plots.size() == 1);
    std::smatch u, v;
    const std::string& script = plots.front().drawing.script;
    REQUIRE(std::regex_search(script, u, std::regex("set xtics ([0-9]+)\n")));
    REQUIRE(std::regex_search(script, v, std::regex("set ytics ([0-9]+)\n")));
    INFO(width_px << ": " << u[1]);
    const int step = std::stoi(u[1]);
    CHECK(v[1] == u[1]);
    // 0 and at most seven more, of four figures each in the 400 points that a plot is wide, and three at least.
    CHECK(width_px / step <= 7);
    CHECK(width_px / step >= 2);
    const std::string figures = std::to_string(step);
    CHECK(std::regex_match(figures, std::regex("[125]0*")));
  }
}

namespace {

constexpr double kPxPerM = -480.0;  // x grows to the left

/// A marker that crosses 300 pixels; its centres are drawn towards the pixels' middles by a sine of this amplitude.
core::AnalysisResults results_with(double amplitude_px, double noise_px) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  core::ClipResult clip;
  for (std::size_t i = 0; i < 1000; ++i) {
    const double u = 400.0 - 0.3017 * static_cast<double>(i);
    const double phase = u - std::round(u);
    const double seen = u - amplitude_px * std::sin(2.0 * std::numbers::pi * phase) + noise_px * normal(random);
    clip.sightings.push_back({i, seen, 200.0, 0.01, 5.0});
    core::MotionPoint point;
    point.x_m = u / kPxPerM;
    point.measured_m = seen / kPxPerM;
    point.smoothed = true;
    clip.motion.push_back(point);
  }
  core::AnalysisResults results;
  results.clips.push_back(std::move(clip));
  return results;
}

}  // namespace

TEST_CASE("centres that are drawn to pixels show it as a harmonic of the phase, others show none") {
  const auto drawn = pixel_locking(phase_points(results_with(0.02, 0.01)));
  REQUIRE(drawn);
  // The phase is that of the centre as it was seen, which is off by 0.02 px itself: 6 % of the first harmonic at most.
  CHECK(std::abs(drawn->amplitude_px - 0.02) < 4.0 * drawn->sd_px + 0.06 * 0.02);
  CHECK(std::abs(drawn->sd_px - 0.01 * std::sqrt(2.0 / 1000.0)) < 1e-4);  // the noise's own sd to 20 %
  const auto free = pixel_locking(phase_points(results_with(0.0, 0.01)));
  REQUIRE(free);
  CHECK(free->amplitude_px < 4.0 * free->sd_px);  // exp(-8): three in ten thousand
  CHECK(pixel_phase_plot(phase_points(results_with(0.02, 0.01)), false).size() == 1);
}

TEST_CASE("the truth gives the same points where the smoothed motion is the truth") {
  const core::AnalysisResults results = results_with(0.02, 0.01);
  validate::RestitutionComparison restitution;
  for (std::size_t i = 0; i < results.clips[0].motion.size(); ++i) {
    const core::MotionPoint& point = results.clips[0].motion[i];
    restitution.points.push_back({0, 0.0, point.x_m, *point.measured_m - point.x_m, i});
  }
  const auto estimated = phase_points(results), known = phase_points(results, restitution);
  REQUIRE(known.size() == estimated.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    CHECK(known[i].phase_px == estimated[i].phase_px);
    CHECK(known[i].error_px == estimated[i].error_px);
  }
}

TEST_CASE("too few centres, tracks, and a marker that stays within a part of a pixel have no harmonic") {
  core::AnalysisResults results = results_with(0.02, 0.01);
  results.clips[0].sightings.resize(10);
  CHECK_FALSE(pixel_locking(phase_points(results)));
  results.clips[0].sightings.clear();
  CHECK(phase_points(results).empty());
  CHECK(pixel_phase_plot(phase_points(results), false).empty());
  std::vector<PixelPhase> still(100);
  for (std::size_t i = 0; i < still.size(); ++i) still[i].phase_px = 0.001 * static_cast<double>(i);
  CHECK_FALSE(pixel_locking(still));
}
