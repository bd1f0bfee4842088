#include "diagnose/tracks/track_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/single_frames/frame_effects.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kPxPerM = 600.0;

/// What stands between a motion and its positions: rows that are late, and an error by the place between two pixels.
struct Filmed {
  double line_s = 0.0;
  double pixel_error_px = 0.0;
  double jitter_s = 0.0;
};

/// Tracks of a camera whose columns lie along the track but for a tilt: 60 rows a metre. Noise of 3 µm.
tests::MadeExperiment filmed(const Filmed& by, unsigned seed) {
  constexpr std::size_t kFine = 100;  // positions between frames, linear: errors of 5 m/s² (1e-4 s)²/8
  constexpr std::size_t kFrames = 150;
  constexpr double kRate = 100.0;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, seed);
  for (std::size_t c = 0; c < made.results.clips.size(); ++c) {
    const std::vector<double> fine =
        tests::made_motion({}, tests::made_launches()[c], {}, (kFrames + 10) * kFine, kRate * kFine);
    core::TrackData track;
    track.frame_rate_hz = kRate;
    for (std::size_t k = 5; k < kFrames; ++k) {
      double row = 60.0 * fine[k * kFine], x = 0.0;
      const double late_s = by.jitter_s * normal(random);
      for (int again = 0; again < 3; ++again) {  // the row at which it is seen is where it then is
        const double at = (static_cast<double>(k) / kRate + by.line_s * row + late_s) * kRate * kFine;
        const auto below = static_cast<std::size_t>(at);
        x = fine[below] + (at - static_cast<double>(below)) * (fine[below + 1] - fine[below]);
        row = 60.0 * x;
      }
      const double u = 500.0 + kPxPerM * x;
      core::MarkerSighting sighting;
      sighting.frame = k - 5;
      sighting.u_px = u;
      sighting.v_px = 120.0 + row;
      track.sightings.push_back(sighting);
      track.frame.push_back(k - 5);
      track.t_s.push_back(static_cast<double>(k - 5) / kRate);
      track.x_m.push_back(x + by.pixel_error_px / kPxPerM * std::sin(2.0 * std::numbers::pi * u) +
                          3e-6 * normal(random));
    }
    track.frame_t_s = track.t_s;
    made.results.clips[c] =
        core::analyze_motion(made.setups[c], track, core::MotionOptions{.lost_frames = core::LostFrameTimes::kept});
    made.results.clips[c].sightings = track.sightings;
  }
  return made;
}

}  // namespace

TEST_CASE("rows that are late are named with their line time from the tracks alone, either way round") {
  for (const double line_s : {3e-5, -2e-5}) {
    const tests::MadeExperiment made = filmed({line_s, 0.0}, 4);
    const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
    INFO("line time " << line_s);
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    CHECK(diagnosis.effects.front().id == "rolling_shutter");
    const auto& line = diagnosis.effects.front().parameters.front();
    CHECK(line.key == "line_s");
    CHECK(std::abs(line.value - line_s) < 5.0 * line.sd);  // 6e-7 by chance
    REQUIRE(diagnosis.gap);
    // A standard error of 1150 points with a noise that is estimated is 0.04: three of them.
    CHECK(diagnosis.gap->after < 1.12);
  }
}

TEST_CASE("an error that goes with the place between two pixels is no effect") {
  // 0.004 px are 6.7 µm: more than twice the noise, at frequencies that follow the speed.
  const tests::MadeExperiment made = filmed({0.0, 0.004}, 6);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(set.modes == diagnose::kPixelModes);
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  const auto& globals = fit.layout->globals();
  const Eigen::MatrixXd covariance = diagnose::common_covariance(fit);
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].kind != diagnose::ParameterLayout::Global::Kind::mode) continue;
    // The sine of one turn is 0.004 of its 0.01 px, the other three are not there: 5 sd, 2e-6 by chance.
    const auto at = static_cast<Eigen::Index>(g);
    const double truth = globals[g].index == 0 ? 0.4 : 0.0;
    CHECK(std::abs(fit.at.global[at] - truth) < 5.0 * std::sqrt(covariance(at, at)));
    CHECK(std::sqrt(covariance(at, at)) < 0.04);  // so that 0.4 is ten of them
  }
  CHECK(diagnose::diagnose_results(made.results, made.setups, {}).verdict == diagnose::Verdict::none);
}

TEST_CASE("errors between pixels are four for each place, none for tracks or a marker that rests") {
  core::ClipResult clip;
  diagnose::TrackedMotion motion;
  std::vector<std::size_t> frames;
  for (std::size_t k = 0; k < 21; ++k) {
    motion.x_m.push_back(0.01 * static_cast<double>(k));
    frames.push_back(k);
  }
  diagnose::add_pixel_modes(clip, frames, 2, motion);
  CHECK(motion.shared_m.empty());
  CHECK(motion.row_px.empty());
  for (std::size_t k = 0; k < 21; ++k) {
    core::MarkerSighting sighting;
    sighting.frame = k;
    sighting.u_px = 10.0 + 0.25 * static_cast<double>(k);
    sighting.v_px = 7.0;
    clip.sightings.push_back(sighting);
  }
  diagnose::add_pixel_modes(clip, frames, 2, motion);
  REQUIRE(motion.shared_m.size() == 6);
  CHECK(motion.shared_m[0].empty());
  CHECK(motion.row_px == std::vector<double>(21, 7.0));
  // 0.2 m over 5 px: 0.01 px are 0.4 mm. sin(2 pi 10.25) = 1, cos(2 pi 10) = 1, sin(4 pi 10.125)...; a few roundings.
  CHECK(std::abs(motion.shared_m[2][1] - 4e-4) < 1e-12);
  CHECK(std::abs(motion.shared_m[3][0] - 4e-4) < 1e-12);
  CHECK(std::abs(motion.shared_m[4][1]) < 1e-12);
  CHECK(std::abs(motion.shared_m[5][1] + 4e-4) < 1e-12);

  for (auto& sighting : clip.sightings) sighting.u_px = 10.0;
  diagnose::TrackedMotion resting;
  resting.x_m = motion.x_m;
  diagnose::add_pixel_modes(clip, frames, 2, resting);
  CHECK(resting.shared_m.empty());
}

TEST_CASE("the noise of filmed positions does not go with how many pixels the marker moves a frame") {
  // 0.01 px are 17 µm beside a noise of 3 µm: at half a pixel a frame neighbours differ by it fully, at a whole one
  // not.
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<diagnose::TrackedMotion> motions;
  for (const double px : {0.5, 1.0, 0.3, 1.5}) {
    diagnose::TrackedMotion motion;
    core::ClipResult clip;
    std::vector<std::size_t> frames;
    for (std::size_t k = 0; k < 200; ++k) {
      core::MarkerSighting sighting;
      sighting.frame = k;
      sighting.u_px = 20.1 + px * static_cast<double>(k) + 1e-4 * static_cast<double>(k * k);
      clip.sightings.push_back(sighting);
      frames.push_back(k);
      motion.t_s.push_back(0.01 * static_cast<double>(k));
      motion.x_m.push_back((sighting.u_px + 0.01 * std::sin(2.0 * std::numbers::pi * sighting.u_px)) / kPxPerM +
                           3e-6 * normal(random));
      motion.outlier.push_back(0);
    }
    diagnose::add_pixel_modes(clip, frames, 0, motion);
    motions.push_back(motion);
  }
  CHECK(diagnose::neighbour_noise(motions[0].t_s, motions[0].x_m, motions[0].outlier) > 9e-6);
  diagnose::measure_noise(motions);
  // 196 residuals that share points know a standard deviation to about 7 %: four of them.
  for (const auto& motion : motions) CHECK(std::abs(motion.sd_m / 3e-6 - 1.0) < 0.28);
}

TEST_CASE("in images a scatter that goes with the speed counts as jitter from ten microseconds on") {
  for (const double jitter_s : {6e-6, 3e-5}) {
    const tests::MadeExperiment made = filmed({0.0, 0.0, jitter_s}, 9);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    REQUIRE(set.images);
    const diagnose::FrameEffect found = diagnose::scan_jitter(set, diagnose::fit_nominal(set));
    INFO("jitter " << jitter_s);
    CHECK((found.log_evidence > 3.0) == (jitter_s > 1e-5));
    if (jitter_s > 1e-5) CHECK(std::abs(found.value - jitter_s) < 5.0 * found.sd);
  }
}

TEST_CASE(
    "where the pattern fits its plane worse than its corners' noise, the errors of camera and plane are as much "
    "larger") {
  tests::MadeExperiment made = filmed({}, 2);
  for (auto& clip : made.results.clips) {
    clip.experiment = "folder";
    clip.scale_sd_relative = 1e-4;
    clip.shared_m = {std::vector<double>(clip.motion.size(), 2e-6)};
  }
  core::CalibrationResult calibration;
  calibration.experiment = "folder";
  calibration.plane_expected_px = 0.01;
  for (const double rms_px : {0.005, 0.03}) {
    calibration.plane_rms_px = rms_px;
    made.results.calibrations = {calibration};
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const double times = std::max(1.0, rms_px / 0.01);
    for (const auto& motion : set.motions) {
      CHECK(std::abs(motion.scale_sd / (1e-4 * times) - 1.0) < 1e-12);
      CHECK(std::abs(motion.shared_m.front().front() / (2e-6 * times) - 1.0) < 1e-12);
    }
  }
}
