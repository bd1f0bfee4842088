#include "core/analysis/see_clip.h"

#include <cmath>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/analysis/clip_to_track.h"
#include "core/pictures/frames/frame_source.h"
#include "tests/catch.h"
#include "tests/core/clip_in_memory.h"
#include "tests/core/lit_scene.h"

using namespace glidelab;

namespace {

const cv::Size kSize(240, 90);
constexpr std::size_t kFrames = 48;
constexpr double kRadius = 8.2, kPixelsPerMetre = 400.0, kRate = 100.0;

cv::Point2d place(std::size_t k) {
  const double t = static_cast<double>(k);
  return {28.3 + 4.9 * t - 0.029 * t * t, 44.2 + 0.11 * t};
}

/// A bull's eye on a dark plate in front of a striped wall.
std::vector<cv::Mat> film_bulls_eye() {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const cv::Point2d c = place(k);
    const auto light = [&](double u, double v) {
      const double x = (u - c.x) / kRadius, y = (v - c.y) / kRadius, r = std::hypot(x, y);
      if (r < 0.33 || (r < 1.0 && r > 0.66)) return 0.8;
      return std::abs(x) < 1.5 && std::abs(y) < 1.5 ? 0.05 : 0.2 + 0.05 * std::sin(0.31 * u);
    };
    frames.push_back(tests::expose_light(kSize, light, true, 1.5, 8100 + k));
  }
  return frames;
}

class TimedClip : public tests::ClipInMemory {
 public:
  using ClipInMemory::ClipInMemory;
  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = ClipInMemory::next();
    if (frame) frame->t_s = static_cast<double>(frame->index) / kRate;
    return frame;
  }
};

}  // namespace

TEST_CASE("A clip of a bull's eye is read five times, and every frame shows it") {
  const std::vector<cv::Mat> frames = film_bulls_eye();
  int opened = 0;
  const core::FrameOpener open = [&](const std::filesystem::path&, const core::CameraSettings&, bool,
                                     std::optional<cv::Size>) {
    ++opened;
    return std::make_unique<TimedClip>(frames);
  };
  core::Experiment experiment;
  experiment.camera.emplace().frame_rate_hz = kRate;
  experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.0};
  experiment.marker.emplace().diameter_m = 2.0 * kRadius / kPixelsPerMetre;
  experiment.clips.resize(1);
  experiment.clips.front().file = "clip.mkv";
  experiment.clips.front().group = "all";
  const core::ImageResults seen = core::tracks_of(experiment, 1, base::no_progress, open);
  // As a bright disc and as a dark one, for the background, for what differs from it, for the pixels around that.
  CHECK(opened == 5);
  const std::vector<core::MarkerSighting>& sightings = seen.tracks.at(0).sightings;
  REQUIRE(sightings.size() == kFrames);
  for (const core::MarkerSighting& sighting : sightings) {
    // Edges of a hundred codes, 50 px long, with a noise of 1.5 codes give 0.005 px; the grid of the look leaves more.
    CHECK(std::hypot(sighting.u_px - place(sighting.frame).x, sighting.v_px - place(sighting.frame).y) < 0.1);
  }
}

namespace {

/// Colours at half the resolution, as most video files have them.
cv::Mat with_coarse_colours(const cv::Mat& bgr) {
  cv::Mat coded, small, coarse;
  cv::cvtColor(bgr, coded, cv::COLOR_BGR2YCrCb);
  cv::resize(coded, small, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(small, coarse, coded.size(), 0.0, 0.0, cv::INTER_NEAREST);
  cv::Mat luma;
  cv::extractChannel(coded, luma, 0);
  cv::insertChannel(luma, coarse, 0);
  cv::Mat out;
  cv::cvtColor(coarse, out, cv::COLOR_YCrCb2BGR);
  return out;
}

class ColourClip : public TimedClip {
 public:
  using TimedClip::TimedClip;
  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = TimedClip::next();
    if (!frame) return frame;
    frame->color = frame->grey;
    frame->grey = cv::Mat();
    cv::cvtColor(frame->color, frame->grey, cv::COLOR_BGR2GRAY);
    return frame;
  }
};

}  // namespace

TEST_CASE("A green ball in side light is placed at its centre, not at that of its colour") {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    tests::LitBall ball;
    ball.centre = place(k);
    ball.radius_px = kRadius;
    ball.lamp_x = -0.5;
    ball.lamp_y = -0.2;
    ball.lamp_z = 0.4;
    ball.ambient = 0.15;
    std::vector<cv::Mat> channels;
    for (const double albedo : {0.2, 0.8, 0.15}) {
      const auto light = [&](double u, double v) {
        const double behind = 0.4 + 0.08 * std::sin(0.31 * u);
        const double on_wall = tests::light_of(ball, u, v, -1.0);
        return on_wall < 0.0 ? behind : albedo * on_wall;
      };
      channels.push_back(tests::expose_light(kSize, light, true, 1.5, 9100 + 3 * k + channels.size()));
    }
    cv::Mat bgr;
    cv::merge(channels, bgr);
    frames.push_back(with_coarse_colours(bgr));
  }
  const core::FrameOpener open = [&](const std::filesystem::path&, const core::CameraSettings&, bool,
                                     std::optional<cv::Size>) { return std::make_unique<ColourClip>(frames); };
  core::Experiment experiment;
  experiment.camera.emplace().frame_rate_hz = kRate;
  experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.0};
  experiment.marker.emplace().diameter_m = 2.0 * kRadius / kPixelsPerMetre;
  experiment.marker->color_bgr = {90, 180, 75};
  experiment.clips.resize(1);
  experiment.clips.front().file = "clip.mkv";
  experiment.clips.front().group = "all";
  const core::TrackData track = core::tracks_of(experiment, 1, base::no_progress, open).tracks.at(0);
  REQUIRE(track.sightings.size() == kFrames);
  cv::Point2d off;
  for (const core::MarkerSighting& sighting : track.sightings)
    off += (cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame)) / static_cast<double>(kFrames);
  // The colour's centroid lies off by the light's, a fifth of the radius. The lit body's centre errs with its size, by
  // a hundredth of the radius.
  CHECK(cv::norm(off) < 0.15);
}
