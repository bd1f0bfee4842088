/// The choice of the marker's path by start_px, in the frame to which it refers.
#include "core/pictures/marker/marker_path.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <random>

#include "base/errors.h"
#include "core/pictures/marker/marker_track.h"
#include "tests/catch.h"
#include "tests/core/small_clip.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

const cv::Size kSize(240, 160);
constexpr std::size_t kFrames = 80;
constexpr double kRadius = 5.0, kRate = 50.0;

/// A marker that comes into view at the left edge near frame 26 and leaves at the right edge.
cv::Point2d late(std::size_t k) {
  return {5.0 * (static_cast<double>(k) - 26.0) - 4.0, 60.3};
}

/// A second marker with the same speed, below the first and ahead of it.
cv::Point2d ahead(std::size_t k) {
  return late(k) + cv::Point2d(40.0, 50.0);
}

using Scene = std::function<void(cv::Mat&, std::size_t)>;

core::TrackedMarker track(const Scene& scene, std::optional<core::PixelPoint> start_px, std::optional<double> start_s) {
  core::MarkerSetup setup;
  setup.diameter_m = 0.02;
  setup.start_px = start_px;
  core::MarkerTracker tracker(
      "clip.mkv", setup, [](cv::Point2d) { return kRadius; }, start_s);
  for (std::size_t k = 0; k < kFrames; ++k) {
    cv::Mat image(kSize, CV_64F, cv::Scalar(60.0));
    scene(image, k);
    core::Frame frame;
    frame.index = k;
    frame.t_s = static_cast<double>(k) / kRate;
    frame.grey = tests::expose(image, 2.0, 5 + k);
    tracker.add(frame);
  }
  return tracker.finish();
}

std::string refusal(const Scene& scene, core::PixelPoint start_px, std::optional<double> start_s) {
  try {
    track(scene, start_px, start_s);
  } catch (const core::NoMarker& error) {
    return error.what();
  }
  return "";
}

core::PixelPoint point(cv::Point2d at) {
  return {at.x, at.y};
}

double worst_px(const core::TrackedMarker& tracked, cv::Point2d (*place)(std::size_t)) {
  double worst = 0.0;
  for (const core::MarkerSighting& seen : tracked.sightings) {
    worst = std::max(worst, cv::norm(cv::Point2d(seen.u_px, seen.v_px) - place(seen.frame)));
  }
  return worst;
}

const Scene kLate = [](cv::Mat& p, std::size_t k) { tests::put_disc(p, late(k), kRadius, 210.0); };
const Scene kTwo = [](cv::Mat& p, std::size_t k) {
  tests::put_disc(p, late(k), kRadius, 210.0);
  tests::put_disc(p, ahead(k), kRadius, 210.0);
};

// A noise of 2 with a contrast of 150 and a radius of 5 px leaves 0.006 px per coordinate; this is the largest of a
// hundred.
constexpr double kWorstPx = 0.05;

}  // namespace

TEST_CASE("a place that is pushed off its neighbours' course is told, and the ends of a path are not") {
  // A glider that slows down: the course beyond an end, a quadratic's, is not its own.
  std::vector<core::PlaceInFrame> places;
  for (std::size_t k = 0; k < 40; ++k) {
    places.push_back(
        {k,
         {300.0 * (1.0 - std::exp(-0.03 * static_cast<double>(k))) + 0.002 * static_cast<double>((k * 7) % 5), 60.0}});
  }
  std::vector<double> off = core::off_course(places);
  CHECK(off.front() == 0.0);
  CHECK(off.back() == 0.0);
  places[25].at.x += 0.3;
  off = core::off_course(places);
  CHECK(off[25] > core::kOffCourse);
}

namespace {

/// The path of an object that is seen at these places in these frames.
core::MarkerPath path_of(const std::vector<std::pair<std::size_t, cv::Point2d>>& places) {
  core::MarkerPath path;
  for (const auto& [frame, at] : places) {
    core::MarkerFit fit;
    fit.centre = at;
    fit.radius_px = kRadius;
    fit.amplitude = 30.0;
    path.push({frame, fit, kRadius});
  }
  return path;
}

/// A blob at rest that is seen with noise of a pixel here, then 60 px away, then here again, in one frame of three.
core::MarkerPath of_two_blobs(cv::Point2d here, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<std::pair<std::size_t, cv::Point2d>> places;
  for (std::size_t k = 0; k < kFrames; k += 3) {
    const bool there = k > 25 && k < 50;
    places.emplace_back(k, here + cv::Point2d((there ? 60.0 : 0.0) + noise(random), noise(random)));
  }
  return path_of(places);
}

}  // namespace

TEST_CASE("what jumps between two places at rest does not travel, and what moves with gaps and bounces does") {
  CHECK(of_two_blobs({40.0, 40.0}, 3).travel_px > 50.0);
  // Twenty-seven differences of two places with noise of 1 px in both coordinates: beyond 6 px in 1 of 1000.
  CHECK(core::steady_travel(of_two_blobs({40.0, 40.0}, 3)) < 6.0);
  std::vector<std::pair<std::size_t, cv::Point2d>> moving, bouncing, hidden;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const double t = static_cast<double>(k);
    moving.emplace_back(k, cv::Point2d(10.0 + 2.5 * t, 50.0));
    // Turned back at 110 px, while it was not seen.
    if (k < 35 || k > 45)
      bouncing.emplace_back(k, cv::Point2d(k < 40 ? 10.0 + 2.5 * t : 110.0 - 2.0 * (t - 40.0), 50.0));
    // At rest, and released while it was not seen.
    if (k < 20 || k > 40) hidden.emplace_back(k, cv::Point2d(k < 25 ? 10.0 : 10.0 + 3.0 * (t - 25.0), 50.0));
  }
  CHECK(core::steady_travel(path_of(moving)) == path_of(moving).travel_px);
  CHECK(core::steady_travel(path_of(bouncing)) == path_of(bouncing).travel_px);
  CHECK(core::steady_travel(path_of(hidden)) == path_of(hidden).travel_px);
}

TEST_CASE("two blobs of the background that come and go are no two markers") {
  core::FollowedPaths followed;
  followed.paths = {of_two_blobs({40.0, 40.0}, 3), of_two_blobs({40.0, 110.0}, 4)};
  followed.frames = kFrames;
  followed.radius_px = kRadius;
  core::MarkerSetup setup;
  setup.diameter_m = 0.02;
  CHECK_THROWS_AS(core::choose_marker(followed, setup, "clip.mkv"), core::NoMarker);
}

TEST_CASE("what moves only in frames that are left out as disturbed is no marker") {
  // Forty frames at rest; before them, it seems to glide there, half as large.
  const auto seen_at = [](std::size_t frame, double u_px, double radius_px) {
    core::MarkerSeen seen;
    seen.frame = frame;
    seen.fit.centre = {u_px, 40.0};
    seen.fit.radius_px = radius_px;
    seen.fit.amplitude = 100.0;
    seen.expected_px = kRadius;
    return seen;
  };
  for (const double at_first : {0.6, 1.0}) {
    core::MarkerPath path;
    path.method = core::MarkerMethod::uniform;
    for (std::size_t k = 0; k < 12; ++k)
      path.push(seen_at(k, 100.0 - 5.0 * static_cast<double>(12 - k), at_first * kRadius));
    for (std::size_t k = 12; k < 52; ++k) path.push(seen_at(k, 100.0, kRadius));
    core::FollowedPaths followed;
    followed.paths = {path};
    followed.frames = 52;
    followed.radius_px = kRadius;
    core::MarkerSetup setup;
    setup.diameter_m = 0.02;
    if (at_first < 1.0) {
      CHECK_THROWS_AS(core::choose_marker(followed, setup, "clip.mkv"), core::NoMarker);
    } else {
      CHECK(core::choose_marker(followed, setup, "clip.mkv").sightings.size() == 52);
    }
  }
}

TEST_CASE("a marker that comes into view later is followed from where it is first fully in view") {
  const auto tracked = track(kLate, {}, {});
  // The window of its fit (1.25 radii plus 2.5 px) is within the image from frame 29 on, until 231 px in frame 73.
  CHECK(tracked.sightings.front().frame >= 27);
  CHECK(tracked.sightings.front().frame <= 31);
  CHECK(tracked.sightings.back().frame >= 71);
  CHECK(tracked.sightings.size() >= 40);
  CHECK(worst_px(tracked, late) < kWorstPx);
}

TEST_CASE("start_px refers to the frame at start_s, and to the first one if none is given") {
  // Its position in frame 45 (0.9 s), and the nearest frame to a time between two frames.
  for (const double start_s : {0.9, 0.9049}) {
    const auto tracked = track(kLate, point(late(45)), start_s);
    CHECK(tracked.sightings.size() >= 40);
    CHECK(worst_px(tracked, late) < kWorstPx);
  }
  CHECK_THAT(refusal(kLate, point(late(45)), {}), Contains("in the first frames") && Contains("start_s"));
  CHECK_THAT(refusal(kLate, point(late(45)), 1.2), Contains("in frame 60, which start_s names"));
}

TEST_CASE("of two that look and move alike start_px takes the one that is there at start_s") {
  CHECK(worst_px(track(kTwo, point(late(50)), 1.0), late) < kWorstPx);
  CHECK(worst_px(track(kTwo, point(ahead(50)), 1.0), ahead) < kWorstPx);
  // The position of the other one a little earlier.
  CHECK_THAT(refusal(kTwo, point(ahead(40)), 1.0), Contains("no marker near start_px"));
}

TEST_CASE("a marker that is at rest until its release is found by its position at rest, at any time before") {
  const Scene released = [](cv::Mat& p, std::size_t k) {
    const double since = k < 40 ? 0.0 : static_cast<double>(k - 40);
    tests::put_disc(p, {60.4 + 0.1 * since * since, 70.2}, kRadius, 210.0);
    tests::put_disc(p, {120.3, 120.6}, kRadius, 210.0);  // always at rest
  };
  for (const double start_s : {0.0, 0.3, 0.6, 0.8}) {
    INFO("start_s = " << start_s);
    const auto tracked = track(released, core::PixelPoint{60.4, 70.2}, start_s);
    CHECK(tracked.sightings.back().frame == kFrames - 1);
    CHECK(tracked.sightings.back().u_px > 200.0);
  }
}

TEST_CASE("the roughness of a path is its noise, whatever cubic it follows, and a lost frame is no step") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0.0, 0.02);
  core::Places smooth, noisy;
  for (std::size_t frame = 0; frame < 2000; ++frame) {
    if (frame % 50 == 7) continue;
    const double t = static_cast<double>(frame) / 2000.0;
    smooth[frame] = {600.0 * t - 300.0 * t * t + 90.0 * t * t * t, 40.0 * t};
    noisy[frame] = smooth[frame] + cv::Point2d(normal(random), normal(random));
  }
  CHECK(*core::roughness_of(smooth) < 1e-9);
  CHECK(*core::jitter_of(smooth) > 1e-5);  // second differences see the motion
  // The median of some 1800 sums that share neighbours: 8 % is a generous three standard deviations.
  CHECK(*core::roughness_of(noisy) == Approx(0.02).epsilon(0.08));
  CHECK_FALSE(core::roughness_of({{3, {}}, {4, {}}, {5, {}}, {6, {}}, {7, {}}}));
}
