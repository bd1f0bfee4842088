#include "core/clip_to_track.h"

#include <cmath>

#include "catch.h"
#include "small_clip.h"
#include "temp_dir.h"

using namespace glidelab;

namespace {

constexpr double kRate = 100.0, kPixelsPerMetre = 400.0, kSpeed = 300.0;  // px/s, along the picture's diagonal
const cv::Size kSize(240, 200);

/// Pixels along the line of motion at a time.
cv::Point2d place(double t) {
  return cv::Point2d(30.0, 25.0) + kSpeed * t * cv::Point2d(0.8, 0.6);
}

core::Experiment experiment_of(const std::filesystem::path& clip, double line_readout_s) {
  core::Experiment experiment;
  experiment.name = "rolling";
  experiment.camera.emplace().frame_rate_hz = kRate;
  if (line_readout_s > 0.0) {
    experiment.camera->shutter = core::Shutter::rolling;
    experiment.camera->line_readout_s = line_readout_s;
  }
  experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.0};
  experiment.marker.emplace().diameter_m = 12.0 / kPixelsPerMetre;
  core::ClipSetup setup;
  setup.name = "clip";
  setup.file = clip;
  setup.mass_kg = 0.3;
  setup.group = "all";
  experiment.clips = {setup};
  return experiment;
}

}  // namespace

TEST_CASE("a rolling shutter's rows have their own times where the experiment declares it") {
  const tests::TempDir dir;
  const double line_readout_s = 4e-5;  // 8 ms for 200 rows
  std::vector<cv::Mat> frames;
  for (int k = 0; k < 45; ++k) {
    // The row on which the marker is seen: v = v(t_k + readout (v - middle row)), solved for v.
    const double middle = 0.5 * (kSize.height - 1), slope = kSpeed * 0.6 * line_readout_s;
    const double v = (place(k / kRate).y - slope * middle) / (1.0 - slope);
    const double t = k / kRate + line_readout_s * (v - middle);
    cv::Mat picture(kSize, CV_64F, cv::Scalar(60.0));
    tests::put_disc(picture, place(t), 6.0, 210.0);
    frames.push_back(picture);
  }
  tests::write_video(dir / "clip.mkv", frames, kRate, 1.0);
  const auto error_of = [&](double declared_s) {
    const auto results = core::tracks_of(experiment_of(dir / "clip.mkv", declared_s), 1);
    const core::TrackData& track = results.tracks.at(0);
    REQUIRE(track.t_s.size() >= 40);
    // The origin is the picture's: x at t minus its first value is the way gone since.
    double worst = 0.0;
    for (std::size_t i = 0; i < track.t_s.size(); ++i) {
      const double way = kSpeed / kPixelsPerMetre * (track.t_s[i] - track.t_s[0]);
      worst = std::max(worst, std::abs(track.x_m[i] - track.x_m[0] - way));
    }
    return worst;
  };
  // Noise of 1 of 150 leaves 0.005 px a coordinate; two positions, the largest of 45: 0.03 px.
  CHECK(error_of(line_readout_s) < 0.03 / kPixelsPerMetre);
  // Not declared: the marker goes down 79 rows, which at 40 us each is 3.2 ms, in which it moves by 0.95 px.
  CHECK(error_of(0.0) > 0.5 / kPixelsPerMetre);
}
