#include "core/pictures/marker/pattern/framed_square.h"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/catch.h"
#include "tests/core/clip_in_memory.h"
#include "tests/core/framed_marker.h"
#include "tests/core/lit_scene.h"

using namespace glidelab;

namespace {

const cv::Size kSize(260, 80);
constexpr std::size_t kFrames = 36;
constexpr double kHalf = 9.6;  // px, of the black square's side

/// It slows down, turns round and comes back.
cv::Point2d place(std::size_t k) {
  const double t = static_cast<double>(k);
  return {215.3 - 9.1 * t + 0.16 * t * t, 41.2 + 0.07 * t};
}

/// The light at an offset from the centre in half sides; negative outside.
using Look = std::function<double(double, double)>;

Look turned_by(double angle_rad, const Look& look) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return [c, s, look](double x, double y) { return look(c * x + s * y, c * y - s * x); };
}

std::vector<cv::Mat> film(const Look& look, bool at_rest = false) {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const cv::Point2d at = place(at_rest ? 8 : k);
    const auto light = [&](double u, double v) {
      const double own = look((u - at.x) / kHalf, (v - at.y) / kHalf);
      return own >= 0.0 ? own : 0.2 + 0.07 * std::sin(0.31 * u) * std::sin(0.23 * v);
    };
    frames.push_back(tests::expose_light(kSize, light, true, 1.5, 5200 + k));
  }
  return frames;
}

std::vector<core::MovingPattern> squares_in(const std::vector<cv::Mat>& frames, double radius_px) {
  const core::ClipAgain clip{[&] { return std::make_unique<tests::ClipInMemory>(frames); }, frames.size()};
  return core::moving_squares(clip, [radius_px](cv::Point2d) { return radius_px; });
}

bool watched(const std::vector<cv::Mat>& frames, double radius_px) {
  core::SquareWatch watch;
  for (std::size_t k = 0; k < frames.size(); ++k)
    watch.add(frames[k], k, [radius_px](cv::Point2d) { return radius_px; });
  return watch.any_moves();
}

}  // namespace

TEST_CASE("a framed square is found in every frame at the centre of its outline, be it turned or not") {
  for (const double angle_deg : {0.0, 17.0, 45.0}) {
    const Look look = turned_by(angle_deg * std::numbers::pi / 180.0, tests::framed_marker);
    const std::vector<cv::Mat> frames = film(look);
    // The stated size is the side, the side of the paper with its margin, or the diagonal.
    for (const double radii : {1.0, tests::kPaperOfFrame, std::numbers::sqrt2}) {
      CAPTURE(angle_deg, radii);
      CHECK(watched(frames, radii * kHalf));
      const auto found = squares_in(frames, radii * kHalf);
      REQUIRE(found.size() == 1);
      const std::vector<core::MarkerSighting>& sightings = found.front().rough.sightings;
      REQUIRE(sightings.size() == kFrames);
      cv::Point2d mean;
      for (const core::MarkerSighting& sighting : sightings) {
        const cv::Point2d off = cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame);
        // Whole pixels along a side of 19: 1/sqrt(12) of one, over the root of the two sides, and more where a whole
        // side flips at once.
        CHECK(cv::norm(off) < 0.5);
        mean += off / static_cast<double>(kFrames);
      }
      CHECK(cv::norm(mean) < 0.08);  // 0.3 px of each, over the root of 36
    }
  }
}

TEST_CASE("a square at rest, a plain one, one of another size, a disc and a ring are no framed square that moves") {
  const Look plain = [](double x, double y) {
    return std::max(std::abs(x), std::abs(y)) < 1.0 ? 0.03 : std::max(std::abs(x), std::abs(y)) < 1.25 ? 0.8 : -1.0;
  };
  const Look disc = [](double x, double y) {
    return std::hypot(x, y) < 1.0 ? 0.03 : std::max(std::abs(x), std::abs(y)) < 1.25 ? 0.8 : -1.0;
  };
  const Look ring = [](double x, double y) {
    const double r = std::hypot(x, y);
    return r < 1.0 && r > 0.6 ? 0.03 : std::max(std::abs(x), std::abs(y)) < 1.25 ? 0.8 : -1.0;
  };
  for (const auto& look : std::array<Look, 3>{plain, disc, ring}) CHECK(squares_in(film(look), kHalf).empty());
  const std::vector<cv::Mat> at_rest = film(tests::framed_marker, true), moving = film(tests::framed_marker);
  CHECK_FALSE(watched(at_rest, kHalf));
  CHECK(squares_in(at_rest, kHalf).empty());
  CHECK(squares_in(moving, 2.0 * kHalf).empty());
  CHECK(squares_in(moving, 0.5 * kHalf).empty());
}
