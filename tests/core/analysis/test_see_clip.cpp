#include "core/analysis/see_clip.h"

#include <cmath>
#include <functional>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/analysis/centroid_wander.h"
#include "core/analysis/clip_to_track.h"
#include "core/pictures/frames/frame_source.h"
#include "tests/catch.h"
#include "tests/core/clip_in_memory.h"
#include "tests/core/framed_marker.h"
#include "tests/core/lit_scene.h"
#include "tests/core/notes.h"

using namespace glidelab;

namespace {

const cv::Size kSize(240, 90);
constexpr std::size_t kFrames = 48;
constexpr double kRadius = 8.2, kPixelsPerMetre = 400.0, kRate = 100.0;

cv::Point2d place(std::size_t k) {
  const double t = static_cast<double>(k);
  return {28.3 + 4.9 * t - 0.029 * t * t, 44.2 + 0.11 * t};
}

/// A bull's eye on a dark plate in front of a striped wall, and a disc of its size at rest if `disc`.
std::vector<cv::Mat> film_bulls_eye(bool disc = false) {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const cv::Point2d c = place(k);
    const auto light = [&](double u, double v) {
      const double x = (u - c.x) / kRadius, y = (v - c.y) / kRadius, r = std::hypot(x, y);
      if (r < 0.33 || (r < 1.0 && r > 0.66)) return 0.8;
      if (std::abs(x) < 1.5 && std::abs(y) < 1.5) return 0.05;
      if (disc && std::hypot(u - 100.0, v - 14.0) < kRadius) return 0.9;
      return 0.2 + 0.05 * std::sin(0.31 * u);
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

TEST_CASE("A clip of a bull's eye is read six times, and every frame shows it, also beside a disc at rest") {
  for (const bool disc : {false, true}) {
    CAPTURE(disc);
    const std::vector<cv::Mat> frames = film_bulls_eye(disc);
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
    // As a bright disc and as a dark one; for the background and the pixels around what was found; for patterns that
    // move and the pixels around them.
    CHECK(opened <= 6);
    const std::vector<core::MarkerSighting>& sightings = seen.tracks.at(0).sightings;
    REQUIRE(sightings.size() == kFrames);
    for (const core::MarkerSighting& sighting : sightings) {
      // Edges of a hundred codes, 50 px long, with a noise of 1.5 codes give 0.005 px; the grid of the look leaves
      // more.
      CHECK(std::hypot(sighting.u_px - place(sighting.frame).x, sighting.v_px - place(sighting.frame).y) < 0.1);
    }
  }
}

TEST_CASE("A square marker with a pattern in its frame is found in every frame, at the centre of its outline") {
  // On a dark body, and on a bright one, on which its paper hardly stands out.
  for (const double body : {0.05, 0.6}) {
    CAPTURE(body);
    std::vector<cv::Mat> frames;
    for (std::size_t k = 0; k < kFrames; ++k) {
      const auto light = [&](double u, double v) {
        const double x = (u - place(k).x) / kRadius, y = (v - place(k).y) / kRadius;
        const double own = tests::framed_marker(x, y);
        if (own >= 0.0) return own;
        if (std::abs(x) < 2.6 && std::abs(y) < 1.7) return body;
        return 0.2 + 0.06 * std::sin(0.31 * u) * std::cos(0.27 * v);
      };
      frames.push_back(tests::expose_light(kSize, light, true, 1.5, 8400 + k));
    }
    const core::FrameOpener open = [&](const std::filesystem::path&, const core::CameraSettings&, bool,
                                       std::optional<cv::Size>) { return std::make_unique<TimedClip>(frames); };
    core::Experiment experiment;
    experiment.camera.emplace().frame_rate_hz = kRate;
    experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.0};
    experiment.marker.emplace().diameter_m = 2.0 * kRadius / kPixelsPerMetre;
    experiment.clips.resize(1);
    experiment.clips.front().file = "clip.mkv";
    experiment.clips.front().group = "all";
    const core::ImageResults seen = core::tracks_of(experiment, 1, base::no_progress, open);
    const auto* const measured = tests::note_of<core::MarkerMeasuredBy>(seen.tracks.at(0).notes);
    REQUIRE(measured != nullptr);
    CHECK(measured->what == core::MarkerMeasuredBy::What::own_look);
    const std::vector<core::MarkerSighting>& sightings = seen.tracks.at(0).sightings;
    REQUIRE(sightings.size() == kFrames);
    cv::Point2d mean;
    for (const core::MarkerSighting& sighting : sightings)
      mean += (cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame)) / static_cast<double>(kFrames);
    // Of the outline's 0.3 px in each frame the root of 48 is left.
    CHECK(cv::norm(mean) < 0.08);
    for (const core::MarkerSighting& sighting : sightings) {
      // As of the bull's eye, without the offset that all frames share.
      const cv::Point2d off = cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame) - mean;
      CHECK(cv::norm(off) < 0.1);
    }
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

namespace {

/// The results of a clip of something green: `look` is its light at an offset in radii, negative outside.
core::ImageResults see_green(const std::function<double(double x, double y, std::size_t frame)>& look) {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    std::vector<cv::Mat> channels;
    for (const double albedo : {0.2, 0.8, 0.15}) {
      const auto light = [&](double u, double v) {
        const double own = look((u - place(k).x) / kRadius, (v - place(k).y) / kRadius, k);
        return own < 0.0 ? 0.4 + 0.08 * std::sin(0.31 * u) : albedo * own;
      };
      cv::Mat image = tests::paint(kSize, light, 4);
      for (double& pixel : cv::Mat_<double>(image)) pixel = 255.0 * tests::srgb_of_light(pixel);
      channels.push_back(tests::expose(image, 1.5, 9100 + 3 * k + channels.size()));
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
  return core::tracks_of(experiment, 1, base::no_progress, open);
}

}  // namespace

TEST_CASE("A green ball in side light is placed at its centre, not at that of its colour") {
  tests::LitBall ball;
  ball.radius_px = 1.0;
  ball.lamp_x = -0.5;
  ball.lamp_y = -0.2;
  ball.lamp_z = 0.4;
  ball.ambient = 0.15;
  const core::TrackData track =
      see_green([&](double x, double y, std::size_t) { return tests::light_of(ball, x, y, -1.0); }).tracks.at(0);
  REQUIRE(track.sightings.size() == kFrames);
  cv::Point2d off;
  for (const core::MarkerSighting& sighting : track.sightings)
    off += (cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame)) / static_cast<double>(kFrames);
  // The colour's centroid lies off by the light's, a fifth of the radius. The lit body's centre errs with its size, by
  // a hundredth of the radius.
  CHECK(cv::norm(off) < 0.15);
}

TEST_CASE("A centroid whose light changes sides along the path may wander, and one in even light does not") {
  // Three prongs: no disc and no sphere.
  const auto results = [](double most_slope) {
    return see_green([=](double x, double y, std::size_t k) {
      const double r = std::hypot(x, y), turn = std::atan2(y, x);
      if (r > 1.25 || (r > 0.3 && std::cos(3.0 * turn) < 0.2)) return -1.0;
      const double part = static_cast<double>(k) / (kFrames - 1.0);
      return 0.5 * (1.0 + most_slope * (2.0 * part - 1.0) * x);
    });
  };
  const core::ImageResults wanders = results(0.6);
  const core::TrackData& track = wanders.tracks.at(0);
  using What = core::MarkerMeasuredBy::What;
  const auto* by = tests::note_of<core::MarkerMeasuredBy>(track.notes);
  REQUIRE(by != nullptr);
  CHECK(by->what == What::centroid);
  REQUIRE(wanders.modes >= core::kWanderModes);
  REQUIRE(track.shared_m.size() == wanders.modes);
  // A slope s shifts the centroid by about s/4 of a radius, from -0.15 to 0.15 radii; in the codes of sRGB by half of
  // that. One of four modes has most of it, and the two centroids share part of it: 0.02 radii or more.
  const std::vector<double>& first = track.shared_m.at(wanders.modes - core::kWanderModes);
  REQUIRE(first.size() == track.x_m.size());
  CHECK(std::abs(first.front()) * kPixelsPerMetre > 0.02 * kRadius);
  CHECK(std::abs(first.front()) * kPixelsPerMetre < 0.2 * kRadius);
  CHECK(first.front() == Approx(-first.back()));
  CHECK(results(0.0).modes + core::kWanderModes == wanders.modes);
}
