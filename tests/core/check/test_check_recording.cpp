#include "core/check/check_recording.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <variant>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/clip_to_track.h"
#include "core/check/check_clip.h"
#include "core/check/recording_findings.h"
#include "core/motion/analyze_motion.h"
#include "tests/catch.h"
#include "tests/core/findings.h"
#include "tests/core/simulated_track.h"
#include "tests/core/small_clip.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::found_as;

namespace {

constexpr double kRate = 100.0, kPixelsPerMetre = 400.0, kSpeed = 300.0, kNoise = 3.0;
constexpr double kMarker = 210.0, kBackground = 60.0;
const cv::Size kSize(240, 200);

/// A disc of 12 px along row 100, 60 frames.
void write_clip(const std::filesystem::path& file) {
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 60; ++k) {
    cv::Mat image(kSize, CV_64F, cv::Scalar(kBackground));
    tests::put_disc(image, {25.0 + kSpeed * k / kRate, 100.0}, 6.0, kMarker);
    frames.push_back(image);
  }
  tests::write_video(file, frames, kRate, kNoise);
}

core::Experiment experiment_of(const std::vector<std::filesystem::path>& clips) {
  core::Experiment experiment;
  experiment.name = "to check";
  experiment.camera.emplace().frame_rate_hz = kRate;
  experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.0};
  experiment.marker.emplace().diameter_m = 12.0 / kPixelsPerMetre;
  for (const std::filesystem::path& file : clips) {
    core::ClipSetup setup;
    setup.name = "clip " + std::to_string(experiment.clips.size());
    setup.file = file;
    setup.mass_kg = 0.3;
    setup.group = "all";
    experiment.clips.push_back(setup);
  }
  return experiment;
}

}  // namespace

TEST_CASE("a check reads each clip once, and finds the noise and the contrast that the clip was given") {
  const tests::TempDir dir;
  write_clip(dir / "clip.mkv");
  std::atomic<int> opened = 0;
  const core::FrameOpener open = [&](const std::filesystem::path& file, const core::CameraSettings& camera,
                                     bool with_color, std::optional<cv::Size> size) {
    ++opened;
    return core::open_frames(file, camera, with_color, size);
  };
  // One file for two clips, as where start_s and end_s cut it.
  const core::Experiment experiment = experiment_of({dir / "clip.mkv", dir / "clip.mkv"});
  const core::RecordingCheck check = core::check_recording(experiment, 2, base::no_progress, open);
  CHECK(opened == 2);
  REQUIRE(check.clips.size() == 2);
  for (const core::ClipCheck& clip : check.clips) {
    INFO(clip.failure);
    CHECK(clip.seen == 60);
    CHECK(clip.width_px == kSize.width);
    CHECK(clip.height_px == kSize.height);
    CHECK(clip.repeated == 0);
    // Of 12 to 24 pairs some 1400 pixels each: the standard deviation of differences to 1 %. Rounding adds 1/12 to the
    // variance, 0.5 %; what the 5 % left out are is known for continuous numbers, and these are whole: 2 %.
    CHECK(std::abs(255.0 * clip.pixel_noise / kNoise - 1.0) < 0.05);
    CHECK(clip.block_steps == 0.0);  // no codec with loss
    // Each of 60 fits knows the amplitude to the noise over the root of its 100 pixels, 0.3 of 150.
    REQUIRE(clip.contrast.has_value());
    CHECK(std::abs(255.0 * *clip.contrast - (kMarker - kBackground)) < 1.0);
    REQUIRE(clip.marker_level.has_value());
    CHECK(std::abs(255.0 * *clip.marker_level - kMarker) < 1.0);
    // The noise that the analysis states.
    const core::TrackData track = core::tracks_of(experiment, 1).tracks.at(0);
    CHECK(clip.position_noise_m == core::analyze_motion(experiment.clips[0], track, {}).position_noise_m);
  }
}

TEST_CASE("a clip that cannot be read is a finding of its own and leaves the others looked at") {
  const tests::TempDir dir;
  write_clip(dir / "clip.mkv");
  base::write_file(dir / "broken.mkv", "no video");
  const core::RecordingCheck check = core::check_recording(experiment_of({dir / "broken.mkv", dir / "clip.mkv"}), 1);
  REQUIRE(check.clips.size() == 2);
  CHECK_FALSE(check.clips[0].failure.empty());
  CHECK(check.clips[1].failure.empty());
  CHECK(check.clips[1].seen == 60);
  CHECK(check.clips[1].contrast.has_value());
  CHECK_FALSE(check.usable);
}

namespace {

/// A clip of 264 frames with nothing wrong but that the marker is seen in [first, first + spanned) only.
core::ClipCheck seen_in(std::size_t first, std::size_t spanned) {
  core::ClipCheck clip;
  clip.name = "clip";
  clip.frames = 264;
  clip.first = first;
  clip.seen = clip.spanned = spanned;
  clip.frame_rate_hz = kRate;
  clip.marker_px = clip.marker_expected_px = 12.0;
  clip.bright_level = 0.8;
  clip.contrast = 0.5;
  return clip;
}

std::vector<core::Finding> findings(const core::ClipCheck& clip) {
  core::RecordingCheck check;
  check.clips = {clip};
  return core::findings_of(experiment_of({"clip.mkv"}), check);
}

}  // namespace

TEST_CASE("a marker that is not seen at a clip's start or end is a finding, worse the longer, less at the edge") {
  CHECK(findings(seen_in(0, 264)).empty());
  CHECK(findings(seen_in(3, 258)).empty());
  const auto late = findings(seen_in(52, 212));
  REQUIRE(late.size() == 1);
  CHECK(late[0].severity == core::Severity::change);
  const auto& first = found_as<core::found::UnseenAtEnd>(late[0]);
  CHECK(first.at_start);
  CHECK(first.frame == 53);
  CHECK(first.frames == 264);
  const auto lost = findings(seen_in(0, 200));
  REQUIRE(lost.size() == 1);
  const auto& last = found_as<core::found::UnseenAtEnd>(lost[0]);
  CHECK_FALSE(last.at_start);
  CHECK(last.frame == 200);
  CHECK(findings(seen_in(100, 164)).at(0).severity == core::Severity::unusable);
  core::ClipCheck entered = seen_in(52, 212);
  entered.entered = true;
  CHECK(findings(entered).at(0).severity == core::Severity::note);
  core::ClipCheck half = seen_in(0, 264);
  half.seen = 135;  // 51 %
  CHECK(findings(half).at(0).severity == core::Severity::unusable);
}

TEST_CASE("a marker that is not found for its size is looked for in others, and then its size is the finding") {
  const tests::TempDir dir;
  write_clip(dir / "clip.mkv");
  for (const double factor : {2.4, 1.0 / 2.4}) {
    core::Experiment experiment = experiment_of({dir / "clip.mkv", dir / "clip.mkv"});
    experiment.marker->diameter_m *= factor;
    const core::RecordingCheck check = core::check_recording(experiment, 2);
    CHECK_FALSE(check.usable);
    REQUIRE_FALSE(check.findings.empty());
    CHECK(check.findings[0].severity == core::Severity::unusable);
    CHECK(check.findings[0].about.clips == std::vector<std::string>{"clip 0", "clip 1"});
    found_as<core::found::MarkerSizeOff>(check.findings[0]);
    // A disc of 12 px, found by another size to a pixel.
    for (const core::ClipCheck& clip : check.clips) CHECK(std::abs(clip.marker_px - 12.0) < 1.0);
  }
}

TEST_CASE("a length in a wrong unit, and a marker that is nowhere, are told without reading a clip dozens of times") {
  const tests::TempDir dir;
  write_clip(dir / "clip.mkv");
  std::vector<cv::Mat> plain(60, cv::Mat(kSize, CV_64F, cv::Scalar(kBackground)));
  tests::write_video(dir / "plain.mkv", plain, kRate, kNoise);
  std::atomic<int> opened = 0;
  const core::FrameOpener counting = [&](const std::filesystem::path& file, const core::CameraSettings& camera,
                                         bool with_color, std::optional<cv::Size> size) {
    ++opened;
    return core::open_frames(file, camera, with_color, size);
  };
  const auto read = [&](const core::Experiment& experiment) {
    opened = 0;
    CHECK_FALSE(core::check_recording(experiment, 1, base::no_progress, counting).usable);
    return opened.load();
  };
  // One frame of the first clip, then of each alone.
  core::Experiment in_mm = experiment_of({dir / "clip.mkv", dir / "plain.mkv"});
  in_mm.marker->diameter_m *= 1000.0;
  CHECK(read(in_mm) <= 1 + 2);
  in_mm.marker->diameter_m *= 1e-6;
  CHECK(read(in_mm) <= 1 + 2 + 6);
  // Alone in its folder, the clip is not searched once more; six other sizes are tried, bright and dark.
  const core::Experiment nowhere = experiment_of({dir / "plain.mkv"});
  opened = 0;
  CHECK_THROWS_AS(core::tracks_of(nowhere, 1, base::no_progress, counting), base::InputError);
  const int thorough = opened;
  CHECK(read(nowhere) <= thorough + 2 * 6);
}

TEST_CASE("what is found is said once, and in the words of the folder that it is about") {
  core::ClipCheck clip = seen_in(0, 264);
  clip.jumps = 1;
  clip.repeated = 20;
  clip.marker_px = 16.0;
  clip.notes = {core::RepeatedFrames{20, 264}, core::MarkerOfOtherSize{1.33}, core::LastFramesUnstamped{}};
  const std::vector<core::Finding> all = findings(clip);
  CHECK(std::count_if(all.begin(), all.end(),
                      [](const core::Finding& finding) { return finding.severity == core::Severity::note; }) == 1);
  const auto* const jumps = tests::found_in<core::found::Jumps>(all);
  REQUIRE(jumps != nullptr);
  CHECK(jumps->jumps == 1);
  const auto* const size = tests::found_in<core::found::MarkerSizeOff>(all);
  REQUIRE(size != nullptr);
  CHECK(size->by_scale);
}

namespace {

/// The findings about the launch, the masses or an interruption of a folder with a track each for `motions`, all filmed
/// for 1.7 s.
std::vector<core::Finding> of_setups(const std::vector<core::ClipSetup>& setups,
                                     const std::vector<core::TrackData>& tracks,
                                     core::Downhill downhill = core::Downhill::plus_x) {
  const tests::TempDir dir;
  core::Experiment experiment;
  experiment.track.downhill = downhill;
  for (std::size_t i = 0; i < setups.size(); ++i) {
    std::string csv = "t_s,x_m\n";
    for (std::size_t k = 0; k < tracks[i].t_s.size(); ++k) {
      csv += std::to_string(tracks[i].t_s[k]) + "," + std::to_string(tracks[i].x_m[k]) + "\n";
    }
    core::ClipSetup setup = setups[i];
    setup.name += "-" + std::to_string(i);
    setup.track = dir / (setup.name + ".csv");
    base::write_file(setup.track, csv);
    experiment.clips.push_back(setup);
  }
  std::vector<core::Finding> findings = core::check_recording(experiment, 1).findings;
  std::erase_if(findings, [](const core::Finding& finding) {
    return !std::holds_alternative<core::found::MassesApart>(finding.found) &&
           !std::holds_alternative<core::found::AgainstStatedLaunch>(finding.found) &&
           !std::holds_alternative<core::found::Interrupted>(finding.found);
  });
  return findings;
}

const tests::Law kSlope{4.3, 0.0071, 0.8};

}  // namespace

TEST_CASE("free motion against the stated launch is a finding that names the clip and both keys, with it is none") {
  using core::Launched;
  const core::TrackData up = tests::film(tests::launch(kSlope, -0.6, 1.7), {});
  const core::TrackData down = tests::film(tests::launch(kSlope, 0.3, 1.7), {});
  const auto clip = [](Launched launched) { return tests::clip_setup(launched, 4.3); };
  CHECK(of_setups({clip(Launched::up), clip(Launched::down)}, {up, down}).empty());
  const auto turned = of_setups({clip(Launched::up)}, {up}, core::Downhill::minus_x);
  REQUIRE(turned.size() == 1);
  CHECK(turned[0].severity == core::Severity::unusable);
  CHECK(turned[0].about.clips == std::vector<std::string>{"up-0"});
  // It turns at v = 0, in closed form; the first smoothing knows that to some frames of 5 ms.
  const double turn_s = std::log1p(0.6 * kSlope.k_1_s / kSlope.a0(-1)) / kSlope.k_1_s;
  const auto& against = found_as<core::found::AgainstStatedLaunch>(turned[0]);
  CHECK(against.motion.direction == 1);
  REQUIRE(against.motion.until_s);
  CHECK(std::abs(*against.motion.until_s - turn_s) < 0.02);
  CHECK(against.launched == "up");
  CHECK(against.downhill == "-X");
  for (const Launched wrong : {Launched::down, Launched::released}) {
    const auto findings = of_setups({clip(wrong)}, {up});
    REQUIRE(findings.size() == 1);
    CHECK(found_as<core::found::AgainstStatedLaunch>(findings[0]).downhill == "+X");
  }
  core::ClipSetup cut = clip(Launched::down);
  cut.start_s = 0.0;  // the user's word
  CHECK(of_setups({cut}, {up}).empty());
}

TEST_CASE("a downhill that turns every launch is said once, with the number of clips, their names and the worst") {
  using core::Launched;
  const core::TrackData up = tests::film(tests::launch(kSlope, -0.6, 1.7), {});
  const core::TrackData down = tests::film(tests::launch(kSlope, 0.3, 1.7), {});
  const auto clip = [](Launched launched) { return tests::clip_setup(launched, 4.3); };
  const auto turned = of_setups({clip(Launched::up), clip(Launched::down)}, {up, down}, core::Downhill::minus_x);
  REQUIRE(turned.size() == 1);
  CHECK(turned[0].about.clips == std::vector<std::string>{"up-0", "down-1"});
  const auto& against = found_as<core::found::AgainstStatedLaunch>(turned[0]);
  CHECK(against.against == 2);
  CHECK(against.clips == 2);
  CHECK(against.clip == "down-1");
  CHECK(against.motion.direction == -1);
  CHECK_FALSE(against.motion.until_s);
  CHECK(against.stated == core::found::AgainstStatedLaunch::Stated::in_track);
}

TEST_CASE("a hand that carries the glider up and rests there is no finding") {
  core::TrackData track = tests::film(tests::SimulatedMotion().rest(2.0).slide(kSlope, 3.6), {200.0, 3.6});
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {  // half a cosine of 0.4 m in 1 s
    if (track.t_s[i] < 1.0) track.x_m[i] += 0.2 * (1.0 + std::cos(std::numbers::pi * track.t_s[i]));
  }
  CHECK(of_setups({tests::clip_setup(core::Launched::released, 4.3)}, {track}).empty());
}

TEST_CASE("a stop or a blow in mid-run is a finding with its time, a turn, a bounce or a stop at the end is none") {
  using core::Launched;
  const auto found = [](const tests::SimulatedMotion& motion) {
    return of_setups({tests::clip_setup(Launched::down, 4.3)}, {tests::film(motion, {200.0, 3.0, 1e-4})});
  };
  const auto run = [] { return tests::SimulatedMotion().kick(0.2).slide(kSlope, 1.2); };
  const auto held = found(run().kick(0.0).rest(0.3).slide(kSlope, 3.0));
  REQUIRE(held.size() == 1);
  CHECK(held[0].severity == core::Severity::change);
  const auto& rest = found_as<core::found::Interrupted>(held[0]);
  CHECK(rest.count == 1);
  CHECK(std::abs(rest.from_s - 1.2) < 0.1);
  CHECK(std::abs(rest.to_s - 1.5) < 0.1);
  const double slower = run().v(1.2) - 0.25;
  const auto hit = found(run().kick(slower).slide(kSlope, 3.0));
  REQUIRE(hit.size() == 1);
  CHECK(std::abs(found_as<core::found::Interrupted>(hit[0]).from_s - 1.2) < 0.1);
  CHECK(found(run().slide(kSlope, 3.0)).empty());
  const double stop_m = run().x(1.2);
  CHECK(found(tests::SimulatedMotion().kick(0.2).slide(kSlope, 3.0, stop_m, 0.8)).empty());
  CHECK(found(tests::SimulatedMotion().kick(0.2).slide(kSlope, 3.0, stop_m)).empty());
  CHECK(of_setups({tests::clip_setup(Launched::up, 4.3)}, {tests::film(tests::launch(kSlope, -0.6, 3.0), {200.0, 3.0})})
            .empty());
}

TEST_CASE("masses a hundred times apart are a finding that names the heavy clips, ninety times are none") {
  const core::TrackData track = tests::film(tests::launch(kSlope, 0.3, 1.7), {});
  const auto clip = [](double mass_kg) { return tests::clip_setup(core::Launched::down, 4.3, mass_kg); };
  const auto grams = of_setups({clip(0.318), clip(221.0), clip(0.415)}, {track, track, track});
  REQUIRE(grams.size() == 1);
  CHECK(grams[0].severity == core::Severity::unusable);
  const auto& apart = found_as<core::found::MassesApart>(grams[0]);
  REQUIRE(apart.heavy.size() == 1);
  CHECK(apart.heavy[0].clip == "down-1");
  CHECK(apart.heavy[0].mass_kg == 221.0);
  CHECK(apart.lightest.clip == "down-0");
  CHECK(of_setups({clip(0.01), clip(0.9)}, {track, track}).empty());
}

TEST_CASE("the exposure comes from how much longer than high the marker gets: L^2 / 12, in any direction") {
  constexpr double kExposure = 0.006, kRadius = 6.0;
  for (const double angle : {0.0, 0.7, 2.0}) {
    std::vector<core::MarkerSighting> sightings;
    std::vector<core::MarkerFit> fits;
    double travel_px = 0.0;
    for (std::size_t k = 0; k < 60; ++k) {
      const double speed_px_s = 600.0 - 8.0 * static_cast<double>(k);
      const double along = kRadius * kRadius / 4.0 + std::pow(speed_px_s * kExposure, 2) / 12.0;
      const double across = kRadius * kRadius / 4.0, c = std::cos(angle), s = std::sin(angle);
      sightings.push_back({k, travel_px * c, travel_px * s, 0.01, kRadius});
      fits.emplace_back().moments = {c * c * along + s * s * across, c * s * (along - across),
                                     s * s * along + c * c * across};
      // A place changes by the mean of two frames' speeds, so that the central difference is a frame's own.
      travel_px += (speed_px_s - 4.0) / kRate;
    }
    const auto smear = core::marker_smear(sightings, fits, kRate);
    REQUIRE(smear.has_value());
    CHECK(std::abs(smear->exposure_s / kExposure - 1.0) < 1e-9);
    for (core::MarkerFit& fit : fits) fit.moments = {9.0, 0.0, 9.0};
    CHECK_FALSE(core::marker_smear(sightings, fits, kRate).has_value());
    fits.pop_back();
    CHECK_FALSE(core::marker_smear(sightings, fits, kRate).has_value());
  }
}

TEST_CASE("the smear of a marker is measured from its images, and counts where it may have come from outside") {
  constexpr double kExposure = 0.008, kStart = 22.0, kFirst = 100.0, kRise = 2500.0;  // s, px, px/s, px/s²
  constexpr int kFrames = 45, kParts = 16;
  const auto place = [](double t) { return kStart + t * (kFirst + 0.5 * kRise * t); };
  const auto checked = [&](double exposure_s) {
    const tests::TempDir dir;
    std::vector<cv::Mat> frames;
    for (int k = 0; k < kFrames; ++k) {
      cv::Mat mean(cv::Size(380, 200), CV_64F, cv::Scalar(0.0));
      for (int part = 0; part < kParts; ++part) {
        cv::Mat image(mean.size(), CV_64F, cv::Scalar(kBackground));
        tests::put_disc(image, {place(k / kRate + ((part + 0.5) / kParts - 0.5) * exposure_s), 100.0}, 6.0, kMarker);
        mean += image / kParts;
      }
      frames.push_back(mean);
    }
    tests::write_video(dir / "clip.mkv", frames, kRate, kNoise);
    return core::check_recording(experiment_of({dir / "clip.mkv"}), 1).clips.at(0);
  };
  const core::ClipCheck smeared = checked(kExposure);
  INFO(smeared.failure);
  REQUIRE(smeared.measured_exposure_s.has_value());
  REQUIRE(smeared.measured_blur_px.has_value());
  // The moments' disc, a little larger than the marker, cuts the ends of a long smear off: it looks shorter, by less
  // than half. (That a short one comes out as it is, test_check_command.cpp tests.)
  CHECK(*smeared.measured_exposure_s < kExposure);
  CHECK(*smeared.measured_exposure_s > 0.5 * kExposure);
  // A speed is the mean over four frames, that of their middle, and speeds rise by 25 px/s a frame: the quantile of 99
  // % of 41 is the largest or the one before, 2.2 % less.
  const double top_px_s = kFirst + kRise * (kFrames - 3) / kRate;
  CHECK(std::abs(smeared.top_speed_px_s / top_px_s - 1.0) < 0.025);
  CHECK(*smeared.measured_blur_px == Approx(smeared.top_speed_px_s * *smeared.measured_exposure_s).epsilon(1e-12));
  // It starts 22 px from the edge: more than three radii, 18 px, less than these and the smear.
  CHECK(smeared.entered);
  CHECK_FALSE(smeared.left);
  const core::ClipCheck sharp = checked(0.0);
  CHECK(sharp.failure.empty());
  CHECK_FALSE(sharp.measured_exposure_s.has_value());
  CHECK_FALSE(sharp.measured_blur_px.has_value());
  CHECK_FALSE(sharp.entered);
}

TEST_CASE("an exposure longer than the time between frames, or than twice that of another clip, is none") {
  const auto clip = [](double exposure_s, double sd_s2) {
    core::ClipCheck check;
    check.lengthening = core::SmearSlope{exposure_s * exposure_s / 12.0, sd_s2};
    check.measured_exposure_s = exposure_s;
    check.measured_blur_px = 9.0;
    return check;
  };
  const auto kept = [](std::vector<core::ClipCheck> clips) {
    core::drop_contradicted_exposures(clips);
    return clips[0].measured_exposure_s.has_value();
  };
  CHECK(kept({clip(0.004, 1e-9)}));
  CHECK(kept({clip(0.004, 1e-9), clip(0.003, 1e-9)}));
  CHECK_FALSE(kept({clip(0.004, 1e-9), clip(0.0008, 1e-9)}));
  CHECK(kept({clip(0.004, 1e-9), clip(0.0008, 1e-6)}));  // the other says nothing
  // Without that exposure it has no smear of 9 px, with which it may have come from outside.
  std::vector<core::ClipCheck> clips{clip(0.004, 1e-9), clip(0.0008, 1e-9)};
  clips[0].width_px = 640;
  clips[0].height_px = 480;
  clips[0].sightings = {{0, 22.0, 200.0, 0.01, 6.0}, {1, 30.0, 200.0, 0.01, 6.0}, {2, 629.0, 200.0, 0.01, 6.0}};
  clips[0].entered = clips[0].left = true;
  core::drop_contradicted_exposures(clips);
  CHECK_FALSE(clips[0].entered);
  CHECK(clips[0].left);  // 10 px from the edge, less than three radii

  // A bar that lengthens with its speed as with an exposure of two frame times.
  const auto checked = [&](double frames_open) {
    const tests::TempDir dir;
    std::vector<cv::Mat> frames;
    const auto place = [](double k) { return 40.0 + 1.2 * k + 0.09 * k * k; };
    for (int k = 0; k < 45; ++k) {
      cv::Mat mean(cv::Size(380, 200), CV_64F, cv::Scalar(0.0));
      constexpr int kParts = 24;
      for (int part = 0; part < kParts; ++part) {
        cv::Mat image(mean.size(), CV_64F, cv::Scalar(kBackground));
        tests::put_disc(image, {place(k + ((part + 0.5) / kParts - 0.5) * frames_open), 100.0}, 6.0, kMarker);
        mean += image / kParts;
      }
      frames.push_back(mean);
    }
    tests::write_video(dir / "clip.mkv", frames, kRate, kNoise);
    return core::check_recording(experiment_of({dir / "clip.mkv"}), 1).clips.at(0);
  };
  const core::ClipCheck within = checked(0.9), beyond = checked(2.0);
  REQUIRE(within.lengthening.has_value());
  CHECK(std::sqrt(12.0 * within.lengthening->s2) < 1.0 / kRate);
  REQUIRE(beyond.lengthening.has_value());
  CHECK(std::sqrt(12.0 * beyond.lengthening->s2) > 1.0 / kRate);
  CHECK_FALSE(beyond.measured_exposure_s.has_value());
}
