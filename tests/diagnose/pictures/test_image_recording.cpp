#include "diagnose/pictures/image_recording.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "diagnose/pictures/image_evidence.h"
#include "diagnose/pictures/image_search.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

/// Second moment along the motion minus that across it, px², at a speed in px/s.
using LengtheningAt = std::function<double(double)>;

constexpr double kStated_s = 0.001;

/// A box of length v T.
LengtheningAt smear_of(double exposure_s) {
  return [exposure_s](double v) { return std::pow(v * exposure_s, 2) / 12.0; };
}

/// Two clips of a marker that runs up to the same place, stops, and comes back, 240 frames at 120 Hz: at 400 and at
/// 250 px/s at first, so that a place is passed at different speeds.
std::vector<diagnose::FilmedClip> filmed(const LengtheningAt& lengthening, double scatter_px2, bool lossy,
                                         unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<diagnose::FilmedClip> clips;
  for (const double v0 : {400.0, 250.0}) {
    auto record = std::make_shared<core::ImageRecord>();
    record->width_px = 480;
    record->height_px = 180;
    record->codec = lossy ? "avc1" : "FFV1";
    record->lossy = lossy;
    for (std::size_t k = 0; k < 240; ++k) {
      const double t = static_cast<double>(k) / 120.0, v = v0 * (1.0 - t);
      core::MarkerLook look;
      look.frame = k;
      look.t_s = t;
      look.u_px = 40.0 + v0 * (t - 0.5 * t * t);
      look.v_px = 90.0;
      look.vv_px2 = 25.0;
      look.stretch_px2 = 0.1 + 0.05 * look.u_px / 480.0 + lengthening(v) + scatter_px2 * normal(random);
      look.uv_px2 = 0.01 * normal(random);
      look.amplitude = 150.0;
      look.background = 40.0;
      record->marker.push_back(look);
    }
    diagnose::FilmedClip clip;
    clip.name = v0 > 300.0 ? "fast" : "slow";
    clip.record = record;
    clip.camera.frame_rate_hz = 120.0;
    clip.camera.exposure_s = kStated_s;
    clip.px_per_m = 400.0;
    clips.push_back(clip);
  }
  return clips;
}

bool is_seen(const std::vector<diagnose::FilmedClip>& clips) {
  const diagnose::ImageEvidence evidence = diagnose::image_evidence(clips);
  return std::ranges::any_of(evidence.findings, [](const auto& one) { return one.id == "exposure_blur" && one.seen; });
}

}  // namespace

TEST_CASE("slower and faster frames tell the square of one exposure", "[pictures]") {
  // Lengthening without noise: T = 5 ms to the rounding of the normal equations, and their ridge of 1e-12.
  const diagnose::ShapeFit exact = diagnose::fit_marker_shape(filmed(smear_of(0.005), 0.0, false, 1));
  REQUIRE(exact.known);
  CHECK(std::abs(exact.slower.s2 / 25e-6 - 1.0) < 1e-5);
  CHECK(std::abs(exact.faster.s2 / 25e-6 - 1.0) < 1e-5);
  // With noise, five standard deviations of either.
  const diagnose::ShapeFit fit = diagnose::fit_marker_shape(filmed(smear_of(0.005), 0.05, false, 2));
  CHECK(std::abs(fit.slower.s2 - 25e-6) < 5.0 * fit.slower.sd_s2);
  CHECK(std::abs(fit.faster.s2 - 25e-6) < 5.0 * fit.faster.sd_s2);
  // A frame at 400 px/s whose moment scatters by 0.05 px² tells T² to 12 * 0.05 / 400², slower ones less well.
  CHECK(fit.single_frame_sd_s2 > 12.0 * 0.04 / (400.0 * 400.0));
  CHECK(fit.single_frame_sd_s2 < 12.0 * 0.06 / (250.0 * 250.0));
  CHECK(std::abs(diagnose::agreed_squared_exposure(fit, kStated_s) - 25e-6) < 2e-6);
}

TEST_CASE("an exposure longer than stated is seen with loss and without", "[pictures]") {
  for (const bool lossy : {false, true}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      INFO("lossy " << lossy << ", seed " << seed);
      // 2.8 px at the top speed: 0.65 px², 6.5 times the scatter of one frame.
      CHECK(is_seen(filmed(smear_of(0.007), 0.1, lossy, seed)));
      CHECK_FALSE(is_seen(filmed(smear_of(kStated_s), 0.1, lossy, seed)));
    }
  }
}

TEST_CASE("a codec's own blur, of the size of its scatter, is no exposure", "[pictures]") {
  // 0.25 px² at the top speed, where single frames scatter by 0.2: in 480 frames far beyond their mean's scatter.
  const LengtheningAt own = [](double v) { return 0.25 * std::pow(v / 400.0, 2); };
  for (unsigned seed = 1; seed <= 5; ++seed) {
    INFO("seed " << seed);
    CHECK_FALSE(is_seen(filmed(own, 0.2, true, seed)));
  }
  // A sensor's noise does average out.
  CHECK(is_seen(filmed(smear_of(0.007), 0.2, false, 1)));
}

TEST_CASE("a lengthening that does not grow with the square of the speed is no exposure", "[pictures]") {
  // It comes with the motion and stays, or comes with a fast one only.
  const LengtheningAt comes_at_once = [](double v) { return 0.6 * (1.0 - std::exp(-std::pow(v / 60.0, 2))); };
  const LengtheningAt comes_late = [](double v) { return 0.6 * std::max(0.0, (v * v / 160000.0 - 0.5) / 0.5); };
  for (const bool lossy : {false, true}) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      INFO("lossy " << lossy << ", seed " << seed);
      CHECK_FALSE(is_seen(filmed(comes_at_once, 0.05, lossy, seed)));
      CHECK_FALSE(is_seen(filmed(comes_late, 0.05, lossy, seed)));
    }
  }
}
