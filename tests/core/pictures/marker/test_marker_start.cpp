// How a marker is first found, and how far its path is followed back: pictures by formulas, forward and backward in
// time.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/pictures/marker/marker_track.h"
#include "tests/catch.h"
#include "tests/core/lit_scene.h"
#include "tests/core/painter.h"

using namespace glidelab;

namespace {

const cv::Size kWide(420, 110);

core::TrackedMarker tracked(const std::vector<cv::Mat>& frames, double radius_px) {
  core::MarkerSetup setup;
  setup.diameter_m = 0.02;
  core::MarkerTracker tracker("clip.mkv", setup, [&](cv::Point2d) { return radius_px; });
  for (std::size_t k = 0; k < frames.size(); ++k) {
    core::Frame frame;
    frame.index = k;
    frame.grey = frames[k];
    tracker.add(frame);
  }
  return tracker.finish();
}

/// A disc above a bright rail, smeared by its motion while the shutter is open: fast at first, then slower.
struct AboveRail {
  static constexpr double kRadius = 12.0, kV = 50.0, kOpen = 0.4;  // px, px, share of the frame time
  static constexpr std::size_t kFrames = 40;
  static double place(double t) { return 32.0 + t * (16.0 - 0.2 * t); }
  static cv::Mat frame(std::size_t k) {
    const double from = place(static_cast<double>(k) - 0.5 * kOpen), to = place(static_cast<double>(k) + 0.5 * kOpen);
    // The share of the exposure in which the disc covers a point.
    const auto light = [&](double u, double v) {
      const double behind = v > kV + 18.0 && v < kV + 48.0 ? 170.0 : 70.0;
      const double up = v - kV;
      if (std::abs(up) >= kRadius) return behind;
      const double half = std::sqrt(kRadius * kRadius - up * up);
      const double covered = std::clamp((std::min(to, u + half) - std::max(from, u - half)) / (to - from), 0.0, 1.0);
      return behind + covered * (210.0 - behind);
    };
    return tests::expose(tests::paint(kWide, light, 4), 1.0, 900 + k);
  }
};

}  // namespace

TEST_CASE("a smeared marker above a bright rail is found in every frame, whatever the direction of time") {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < AboveRail::kFrames; ++k) frames.push_back(AboveRail::frame(k));
  for (const bool backward : {false, true}) {
    CAPTURE(backward);
    const core::TrackedMarker marker = tracked(frames, AboveRail::kRadius);
    CHECK(marker.sightings.size() == AboveRail::kFrames);
    for (const core::MarkerSighting& seen : marker.sightings) {
      const std::size_t k = backward ? AboveRail::kFrames - 1 - seen.frame : seen.frame;
      // The mean of the place over the exposure differs from that of its middle by 0.4 / 24 kOpen^2 < 0.003 px. A
      // contrast of 140 and a noise of 1 make 0.002 px; the ends of the smear are no ellipse's, symmetrically.
      CHECK(std::abs(seen.u_px - AboveRail::place(static_cast<double>(k))) < 0.1);
    }
    std::reverse(frames.begin(), frames.end());
  }
}

TEST_CASE("a streak that no search finds is followed back beyond the last search") {
  // A disc whose smear shrinks from three diameters to none: as a streak it is too long for a disc at first.
  constexpr double kRadius = 5.0, kTop = 20.0, kFall = 0.5;  // px, px/frame, px/frame²
  constexpr std::size_t kFrames = 40;
  const auto place = [&](double t) { return 40.0 + t * (kTop - 0.5 * kFall * t); };
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const double t = static_cast<double>(k), from = place(t - 0.5), to = place(t + 0.5);
    const auto light = [&](double u, double v) {
      const double up = v - 50.0;
      if (std::abs(up) >= kRadius) return 50.0;
      const double half = std::sqrt(kRadius * kRadius - up * up);
      const double covered = std::clamp((std::min(to, u + half) - std::max(from, u - half)) / (to - from), 0.0, 1.0);
      return 50.0 + 160.0 * covered;
    };
    frames.push_back(tests::expose(tests::paint(cv::Size(500, 100), light, 4), 1.0, 700 + k));
  }
  CHECK(tracked(frames, kRadius).sightings.size() == kFrames);
  std::reverse(frames.begin(), frames.end());
  CHECK(tracked(frames, kRadius).sightings.size() >= kFrames - 4);  // lost where the streak is longest, if at all
}

TEST_CASE("a sphere lit from one side is found in every frame") {
  constexpr double kRadius = 9.6;
  constexpr std::size_t kFrames = 40;
  // 69 degrees off the camera's axis, from the left, the right or above.
  for (const auto& [x, y] : {std::pair(-0.93, 0.0), std::pair(0.9, 0.25), std::pair(0.1, -0.92)}) {
    CAPTURE(x, y);
    std::vector<cv::Mat> frames;
    const auto place = [](std::size_t k) {
      return cv::Point2d(30.3 + 6.1 * static_cast<double>(k), 50.4 + 0.13 * static_cast<double>(k));
    };
    for (std::size_t k = 0; k < kFrames; ++k) {
      tests::LitBall ball;
      ball.centre = place(k);
      ball.radius_px = kRadius;
      ball.lamp_x = 0.75 * x;
      ball.lamp_y = 0.75 * y;
      ball.lamp_z = 0.75 * 0.36;
      ball.ambient = 0.02;
      frames.push_back(tests::expose_light(
          cv::Size(320, 110), [&](double u, double v) { return tests::light_of(ball, u, v, 0.1); }, false, 1.5,
          40 + k));
    }
    const core::TrackedMarker marker = tracked(frames, kRadius);
    CHECK(marker.sightings.size() == kFrames);
    CHECK(marker.method == core::MarkerMethod::shaded);
    cv::Point2d mean;
    for (const core::MarkerSighting& seen : marker.sightings)
      mean += (cv::Point2d(seen.u_px, seen.v_px) - place(seen.frame)) * (1.0 / kFrames);
    // A disc is fitted to the lit part: its centre lies towards the lamp, always at the same place.
    CHECK(cv::norm(mean) < 0.35 * kRadius);
    double squares = 0.0;
    for (const core::MarkerSighting& seen : marker.sightings) {
      const cv::Point2d off = cv::Point2d(seen.u_px, seen.v_px) - place(seen.frame) - mean;
      squares += off.dot(off) / kFrames;
    }
    CHECK(std::sqrt(squares) < 0.15);
  }
}

TEST_CASE("a disc counts as shaded only if its shading is the same from frame to frame") {
  constexpr double kRadius = 7.0;
  constexpr std::size_t kFrames = 40;
  const auto method_of = [&](double size, bool turns) {
    std::vector<cv::Mat> frames;
    for (std::size_t k = 0; k < kFrames; ++k) {
      const cv::Point2d at(30.3 + 6.1 * static_cast<double>(k), 50.4);
      const double angle = turns ? 2.4 * static_cast<double>(k) : 0.7;  // the golden angle: no direction is preferred
      const auto light = [&](double u, double v) {
        const cv::Point2d d = cv::Point2d(u, v) - at;
        if (cv::norm(d) > kRadius) return 50.0;
        return 50.0 + 150.0 * (1.0 + size * (d.x * std::cos(angle) + d.y * std::sin(angle)) / kRadius);
      };
      frames.push_back(tests::expose(tests::paint(cv::Size(320, 100), light, 6), 0.5, 60 + k));
    }
    return tracked(frames, kRadius).method;
  };
  CHECK(method_of(0.15, false) == core::MarkerMethod::shaded);
  CHECK(method_of(0.06, true) == core::MarkerMethod::uniform);
  CHECK(method_of(0.0, false) == core::MarkerMethod::uniform);
}
