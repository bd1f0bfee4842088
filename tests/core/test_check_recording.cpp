#include "core/check_recording.h"

#include <atomic>
#include <cmath>

#include "base/staged_output.h"
#include "catch.h"
#include "small_clip.h"
#include "temp_dir.h"

using namespace glidelab;

namespace {

constexpr double kRate = 100.0, kPixelsPerMetre = 400.0, kSpeed = 300.0, kNoise = 3.0;
constexpr double kMarker = 210.0, kBackground = 60.0;
const cv::Size kSize(240, 200);

/// A disc of 12 px along row 100, 60 frames.
void write_clip(const std::filesystem::path& file) {
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 60; ++k) {
    cv::Mat picture(kSize, CV_64F, cv::Scalar(kBackground));
    tests::put_disc(picture, {25.0 + kSpeed * k / kRate, 100.0}, 6.0, kMarker);
    frames.push_back(picture);
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
    // Each of 60 fits knows the amplitude to the noise over the root of its 100 pixels, 0.3 of 150.
    REQUIRE(clip.contrast.has_value());
    CHECK(std::abs(255.0 * *clip.contrast - (kMarker - kBackground)) < 1.0);
    REQUIRE(clip.marker_level.has_value());
    CHECK(std::abs(255.0 * *clip.marker_level - kMarker) < 1.0);
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
