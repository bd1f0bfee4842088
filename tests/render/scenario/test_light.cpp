#include "render/scenario/scenario_data.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tests/catch.h"
#include "tests/render/made_clip.h"

using namespace glidelab;
using namespace glidelab::render;
using namespace glidelab::render::tests;

namespace {

/// A glider that leaves the image's left part alone; everything square on, 150 px/m.
std::string text(const std::string& sections, const std::string& camera = "") {
  return fmt::format(
      "{}\n[camera]\nwidth_px = 240\nheight_px = 180\nframe_rate_hz = 97.0\nexposure_s = 0.004\nfocal_px = [300.0, "
      "300.0]\nposition_m = [0.0, 0.0, 2.0]\n{}\n[calibration]\ninner_corners = [4, 3]\nsquare_m = 0.05\nviews = 3\n"
      "[marker]\ndiameter_m = 0.03\n[[configuration]]\nname = \"m\"\nmass_kg = 0.3\nincline_deg = 0.0\n"
      "[[configuration.clip]]\nname = \"c\"\nlaunched = \"down\"\nx0_m = 0.1\nv0_m_s = 0.8\nduration_s = 0.15\n",
      sections, camera);
}

double mean(const FloatImage& image, const PixelRect& rect) {
  double sum = 0.0;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (const float value : image.row(y, rect.x, rect.width)) sum += static_cast<double>(value);
  }
  return sum / rect.width / rect.height;
}

constexpr PixelRect kAll{0, 0, 240, 180};

/// The mean level of every frame.
std::vector<double> levels(const std::string& sections, const std::string& camera = "", const PixelRect& rect = kAll) {
  const MadeClip clip(scenario_of(text(sections, camera)));
  std::vector<double> found;
  clip.each_frame(
      [&](const FrameMotion& frame, ClipRenderer& renderer) { found.push_back(mean(renderer.expected(frame), rect)); });
  return found;
}

}  // namespace

TEST_CASE("The mean of flicker over an exposure is its integral") {
  // Against 10,000 midpoints, whose error is (pi f T / n)²/6 of the depth, below 1e-7.
  Light light;
  light.flicker_depth = 0.6;
  light.flicker_hz = 100.0;
  light.flicker_phase_rad = 0.7;
  for (const double exposure_s : {1e-9, 0.001, 0.01, 0.017}) {
    double sum = 0.0;
    for (int i = 0; i < 10000; ++i) sum += flicker_at(light, 0.0123 + (i + 0.5) / 10000.0 * exposure_s) / 10000.0;
    CHECK(std::abs(mean_flicker(light, 0.0123, exposure_s) - sum) < 1e-6);
  }
}

TEST_CASE("The frames' mean level follows level and flicker") {
  // Single precision sums of 43,200 values: 1e-6 of the mean.
  const std::vector<double> plain = levels("");
  const std::vector<double> half = levels("[light]\nlevel = 0.5\n");
  const std::vector<double> lamp =
      levels("[light]\nflicker_depth = 0.4\nflicker_hz = 100.0\nflicker_phase_deg = 30.0\n");
  REQUIRE(plain.size() == 15);
  double least = 1e9, most = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    CAPTURE(k);
    CHECK(std::abs(half[k] / plain[k] - 0.5) < 1e-6);
    // 1 + d sinc(pi f T) cos(2 pi f (t + T/2) + phase)
    const double turn = std::numbers::pi * 100.0 * 0.004;
    const double t_s = static_cast<double>(k) / 97.0 + 0.002;
    const double factor =
        1.0 + 0.4 * std::sin(turn) / turn * std::cos(2.0 * std::numbers::pi * 100.0 * t_s + std::numbers::pi / 6.0);
    // The glider's smear is weighted by the light of its instants: 2e-4 of a mean of which it is a tenth.
    CHECK(std::abs(lamp[k] / plain[k] - factor) < 2e-4);
    least = std::min(least, factor);
    most = std::max(most, factor);
  }
  CHECK(most - least > 0.2);  // the beat of 97 and 100 Hz is seen
}

TEST_CASE("With a rolling shutter flicker becomes bands") {
  // 180 rows of 50 µs are 9 ms, most of a period of 100 Hz.
  const std::string rolling = "[shutter]\nkind = \"rolling\"\nline_readout_s = 5e-5\n";
  const MadeClip plain(scenario_of(text("", rolling)));
  const MadeClip lamp(scenario_of(text("[light]\nflicker_depth = 0.4\nflicker_hz = 100.0\n", rolling)));
  std::vector<FloatImage> dull;
  plain.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) { dull.push_back(renderer.expected(frame)); });
  std::size_t k = 0;
  lamp.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) {
    const FloatImage& banded = renderer.expected(frame);
    for (const int row : {0, 45, 90, 179}) {
      const PixelRect left{0, row, 100, 1};  // the glider is to the right
      const double expected = mean_flicker(lamp.scenario.light, static_cast<double>(k) / 97.0 + 5e-5 * row, 0.004);
      CHECK(std::abs(mean(banded, left) / mean(dull[k], left) - expected) < 1e-5);
    }
    ++k;
  });
}

TEST_CASE("A gradient makes light exp(g x) times as bright at x") {
  // The wall is at z = -0.6, 2.6 m away: x = (u - 119.5) 2.6 / 300. Its own texture is the same in both images.
  const MadeClip plain(scenario_of(text("")));
  const MadeClip graded(scenario_of(text("[light]\ngradient_per_m = [0.4, -0.2]\n")));
  for (const auto& [u, v] : {std::pair{10, 10}, {120, 20}, {230, 15}}) {
    const double x = (u - 119.5) * 2.6 / 300.0;
    const double y = -(v - 89.5) * 2.6 / 300.0;
    const double ratio =
        static_cast<double>(graded.background_e.at(u, v)) / static_cast<double>(plain.background_e.at(u, v));
    CHECK(std::abs(ratio / std::exp(0.4 * x - 0.2 * y) - 1.0) <
          2e-4);  // of the mean over a pixel: 1e-6; exp of a shader
  }
}

TEST_CASE("A ring light adds to the marker what it says, at the reference point's distance, and to nothing else") {
  const MadeClip plain(scenario_of(text("")));
  const MadeClip lit(scenario_of(text("[light]\nring_light = 3.0\n")));
  CHECK(plain.background_e.values == lit.background_e.values);
  const auto radiance = [](const MadeClip& clip, double x_m) {
    return glider(clip.scenario, clip.scene, clip.configuration.body, x_m).marker->radiance;
  };
  CHECK(std::abs(radiance(lit, 0.0) - radiance(plain, 0.0) - 3.0) < 1e-12);
  // 0.6 m off at 2 m the lamp is sqrt(4.36) m away.
  CHECK(std::abs(radiance(lit, 0.6) - radiance(plain, 0.6) - 3.0 * 4.0 / 4.36) < 1e-12);
}

TEST_CASE("A reflection adds its light: 2 pi radiance (radius f/Z)², where it is, as it moves") {
  // A spot on the wall's left part, seen 2 m away: sigma = 0.02 * 300 / 2 = 3 px. Six standard deviations leave 1e-8;
  // sums in single precision.
  const std::string spot = "[[light.reflection]]\nposition_m = [-0.4, 0.3, 0.0]\nradius_m = 0.02\nradiance = 1.5\n";
  const MadeClip plain(scenario_of(text("")));
  const MadeClip still(scenario_of(text(spot)));
  const MadeClip moving(scenario_of(text(spot + "velocity_m_s = [0.5, 0.0, 0.0]\n")));
  const MadeClip following(scenario_of(text(spot + "follow = 0.5\n")));
  const double white_e = electrons_of_white(plain.scenario);
  std::vector<FloatImage> dull;
  plain.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) { dull.push_back(renderer.expected(frame)); });
  const auto check = [&](const MadeClip& clip, const auto& x_m) {
    clip.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) {
      const FloatImage& bright = renderer.expected(frame);
      double sum = 0.0, u = 0.0, v = 0.0;
      for (int y = 0; y < 90; ++y) {
        for (int x = 0; x < 125; ++x) {
          const double more = static_cast<double>(bright.at(x, y)) - static_cast<double>(dull[frame.frame].at(x, y));
          sum += more;
          u += more * x;
          v += more * y;
        }
      }
      CAPTURE(frame.frame);
      CHECK(std::abs(sum / (white_e * 1.5 * 2.0 * std::numbers::pi * 9.0) - 1.0) < 1e-4);
      CHECK(std::abs(u / sum - (119.5 + 150.0 * x_m(frame))) < 2e-3);
      CHECK(std::abs(v / sum - (89.5 - 150.0 * 0.3)) < 2e-3);
    });
  };
  check(still, [](const FrameMotion&) { return -0.4; });
  check(moving, [](const FrameMotion& frame) { return -0.4 + 0.5 * (frame.start_s + 0.002); });
  check(following, [](const FrameMotion& frame) { return -0.4 + 0.5 * frame.middle.x_m; });
}

TEST_CASE("The glider hides a reflection behind it and not one before it") {
  const std::string spot = "[[light.reflection]]\nposition_m = [0.15, -0.008, 0.0]\nradius_m = 0.01\nradiance = 2.0\n";
  const auto plain = levels("");
  const auto behind = levels(spot);
  const auto before = levels(spot + "in_front = true\n");
  // 2 pi 2 (1.5 px)² of white, in the mean of all pixels.
  const double whole =
      electrons_of_white(scenario_of(text(""))) * 2.0 * 2.0 * std::numbers::pi * 2.25 / (240.0 * 180.0);
  CHECK(std::abs((before[5] - plain[5]) / whole - 1.0) < 1e-3);
  CHECK((behind[5] - plain[5]) / whole <
        0.02);  // x = 0.14 m in frame 5; the body reaches 2.6 standard deviations up and down
}
