#include "core/check/light_findings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/check/check_recording.h"
#include "tests/catch.h"
#include "tests/core/findings.h"
#include "tests/core/small_clip.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::found_in;

namespace {

constexpr double kRate = 100.0, kPixelsPerMetre = 400.0, kStep_px = 3.0, kStart_px = 25.0;

/// Relative light at a column of the image and a time in seconds.
using Light = std::function<double(double, double)>;

/// A bright or dark disc of 12 px on a wall, 60 frames along row 100, in this light.
core::RecordingCheck checked(const Light& light, double exposure_s, bool dark = false) {
  const tests::TempDir dir;
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 60; ++k) {
    cv::Mat image(200, 240, CV_64F, cv::Scalar(dark ? 180.0 : 60.0));
    tests::put_disc(image, {kStart_px + kStep_px * k, 100.0}, 6.0, dark ? 30.0 : 210.0);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) image.at<double>(v, u) *= light(u, k / kRate);
    }
    frames.push_back(image);
  }
  tests::write_video(dir / "clip.mkv", frames, kRate, 1.0);
  core::Experiment experiment;
  experiment.camera.emplace().frame_rate_hz = kRate;
  experiment.camera->exposure_s = exposure_s;
  experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.1};
  experiment.marker.emplace().diameter_m = 12.0 / kPixelsPerMetre;
  core::ClipSetup& setup = experiment.clips.emplace_back();
  setup.name = "run";
  setup.file = dir / "clip.mkv";
  setup.mass_kg = 0.3;
  return core::check_recording(experiment, 1);
}

double even(double, double) {
  return 1.0;
}

double shadow(double u, double) {
  return 0.825 - 0.175 * std::erf((u - 130.0) / 3.0);
}

}  // namespace

TEST_CASE("a check says nothing of even light") {
  for (const bool dark : {false, true}) {
    const core::RecordingCheck check = checked(even, 0.002, dark);
    CHECK(found_in<core::found::ShadowEdge>(check.findings) == nullptr);
    CHECK(found_in<core::found::LightFalls>(check.findings) == nullptr);
    CHECK(found_in<core::found::LightFlickers>(check.findings) == nullptr);
  }
}

TEST_CASE("a check names the place, the size and the frames of a shadow's edge on the path") {
  for (const bool dark : {false, true}) {
    INFO("dark " << dark);
    const core::RecordingCheck check = checked(shadow, 0.002, dark);
    const auto* const edge = found_in<core::found::ShadowEdge>(check.findings);
    REQUIRE(edge != nullptr);
    // From 1 to 0.65; what is within half a diameter of the edge does not count.
    CHECK(std::abs(edge->fall - 0.35) < 0.03);
    CHECK(edge->downhill);
    if (dark) CHECK_FALSE(edge->of_marker);
    // The marker's centre is at column 130 in frame 35, counted from 0, and within 6 px of there for two on each side.
    REQUIRE(edge->frames.size() == 1);
    CHECK(edge->clip == "run");
    CHECK(edge->frames[0].first >= 33);
    CHECK(edge->frames[0].first <= 36);
    CHECK(edge->frames[0].last >= 36);
    CHECK(edge->frames[0].last <= 39);
    const auto finding = std::ranges::find_if(check.findings, [](const core::Finding& one) {
      return std::holds_alternative<core::found::ShadowEdge>(one.found);
    });
    CHECK(finding->severity == core::Severity::note);
    // x along the track, from the same clip's positions.
    const core::ClipCheck& clip = check.clips[0];
    const auto at = std::ranges::find(clip.brightness.points, std::size_t{35}, &core::LitPoint::frame);
    REQUIRE(at != clip.brightness.points.end());
    CHECK(std::abs(edge->x_m - at->x_m) < 6.0 / kPixelsPerMetre);
  }
}

TEST_CASE("a check says by how much the light falls in a metre, and to which side") {
  for (const double per_px : {-0.002, 0.002}) {
    const core::RecordingCheck check =
        checked([&](double u, double) { return 0.7 * std::exp(per_px * (u - 120.0)); }, 0.002);
    CHECK(found_in<core::found::ShadowEdge>(check.findings) == nullptr);
    const auto* const falls = found_in<core::found::LightFalls>(check.findings);
    REQUIRE(falls != nullptr);
    CHECK(std::abs(falls->part_per_m - (1.0 - std::exp(-0.002 * kPixelsPerMetre))) < 0.03);
    CHECK(falls->towards ==
          (per_px < 0.0 ? core::found::LightFalls::Towards::right : core::found::LightFalls::Towards::left));
    // r²/4 times the slope, 9 px² * 0.002 / px.
    CHECK(std::abs(falls->displaces_m * kPixelsPerMetre / 0.018 - 1.0) < 0.1);
  }
}

TEST_CASE("a check names lamps that flicker where they displace the marker, and takes no flicker for a shadow") {
  const auto flicker = [](double, double t) { return 0.9 + 0.09 * std::cos(2.0 * std::numbers::pi * 30.0 * t); };
  const core::RecordingCheck check = checked(flicker, 0.008);
  const auto* const flickers = found_in<core::found::LightFlickers>(check.findings);
  REQUIRE(flickers != nullptr);
  CHECK(std::abs(flickers->f_hz - 30.0) < 0.3);
  // What the frames show, before the average over the exposure: 0.1 / (sin x / x), x = pi 30 Hz 8 ms.
  const double x = std::numbers::pi * 30.0 * 0.008;
  CHECK(std::abs(flickers->depth - 0.1 * x / std::sin(x)) < 0.005);
  CHECK(found_in<core::found::ShadowEdge>(check.findings) == nullptr);
  CHECK(found_in<core::found::LightFalls>(check.findings) == nullptr);
  // The noise of a pixel is 1 code, whatever the lamps do: a contrast of some 150 is far above 20 times that.
  CHECK(255.0 * check.clips[0].pixel_noise < 1.3);
  CHECK(found_in<core::found::NoisyContrast>(check.findings) == nullptr);
  // Within 50 µs the light hardly changes.
  const core::RecordingCheck brief = checked(flicker, 5e-5);
  CHECK(found_in<core::found::LightFlickers>(brief.findings) == nullptr);
}
