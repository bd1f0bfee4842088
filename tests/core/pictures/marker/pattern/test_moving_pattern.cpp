#include "core/pictures/marker/pattern/moving_pattern.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "tests/catch.h"
#include "tests/core/clip_in_memory.h"
#include "tests/core/lit_scene.h"

using namespace glidelab;

namespace {

const cv::Size kSize(240, 80);
constexpr std::size_t kFrames = 48;
constexpr double kRadius = 7.4;

/// It slows down, turns round and comes back.
cv::Point2d place(std::size_t k) {
  const double t = static_cast<double>(k);
  return {205.3 - 7.1 * t + 0.11 * t * t, 41.2 + 0.02 * t};
}

/// The light at an offset from the centre, in radii; negative outside.
using Look = std::function<double(double, double)>;

/// A white plate, three times as wide as the pattern on it.
Look on_plate(const Look& dark) {
  return [dark](double x, double y) {
    if (std::abs(x) > 3.0 || std::abs(y) > 1.8) return -1.0;
    return dark(x, y) > 0.0 ? 0.05 : 0.8;
  };
}

bool in_ring(double x, double y, double inner, double outer) {
  const double r = std::hypot(x, y);
  return r > inner && r < outer;
}

const Look kRing = on_plate([](double x, double y) { return in_ring(x, y, 0.6, 1.0) ? 1.0 : 0.0; });
const Look kBullsEye =
    on_plate([](double x, double y) { return in_ring(x, y, 0.66, 1.0) || in_ring(x, y, -1.0, 0.33) ? 1.0 : 0.0; });
const Look kTilted = on_plate(
    [](double x, double y) { return in_ring(x / 0.8, y, 0.66, 1.0) || in_ring(x / 0.8, y, -1.0, 0.33) ? 1.0 : 0.0; });
const Look kCross = on_plate([](double x, double y) {
  return std::min(std::abs(x), std::abs(y)) < 0.25 && std::max(std::abs(x), std::abs(y)) < 1.0 ? 1.0 : 0.0;
});
const Look kQuadrants = on_plate([](double x, double y) { return std::hypot(x, y) < 1.0 && x * y > 0.0 ? 1.0 : 0.0; });

/// What moves, before a wall with a stripe, bars, and a bull's eye of the same size at rest.
std::vector<cv::Mat> film(const Look& look, double second_px = 0.0) {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const auto light = [&](double u, double v) {
      for (const double off : {0.0, second_px}) {
        const double own = look((u - place(k).x - off) / kRadius, (v - place(k).y) / kRadius);
        if (own >= 0.0) return own;
      }
      const double r = std::hypot(u - 160.0, v - 12.0) / kRadius;
      if (r < 0.33 || (r > 0.66 && r < 1.0)) return 0.6;
      return v > 60.0 && v < 66.0 ? 0.45 : 0.2 + 0.05 * std::sin(0.31 * u);
    };
    cv::Mat image = tests::paint(kSize, light, 5);
    for (double& pixel : cv::Mat_<double>(image)) pixel = 255.0 * tests::srgb_of_light(pixel);
    frames.push_back(tests::expose(image, 1.5, 4100 + k));
  }
  return frames;
}

std::vector<core::MovingPattern> patterns_in(const std::vector<cv::Mat>& frames) {
  const core::ClipAgain clip{[&] { return std::make_unique<tests::ClipInMemory>(frames); }, frames.size()};
  return core::moving_patterns(clip, [](cv::Point2d) { return kRadius; });
}

}  // namespace

TEST_CASE("Patterns on a plate that stands out more than they do are found in every frame, at their own centres") {
  struct Case {
    const char* name;
    const Look& look;
  };
  for (const Case& made : {Case{"ring", kRing}, Case{"bull's eye", kBullsEye}, Case{"tilted bull's eye", kTilted},
                           Case{"cross", kCross}, Case{"quadrants", kQuadrants}}) {
    INFO(made.name);
    const std::vector<core::MovingPattern> found = patterns_in(film(made.look));
    REQUIRE_FALSE(found.empty());
    const std::vector<core::MarkerSighting>& sightings = found.front().rough.sightings;
    CHECK(sightings.size() == kFrames);
    double squares = 0.0;
    for (const core::MarkerSighting& sighting : sightings) {
      const cv::Point2d off = cv::Point2d(sighting.u_px, sighting.v_px) - place(sighting.frame);
      CHECK(cv::norm(off) < 0.3);
      squares += off.dot(off) / 2.0 / static_cast<double>(sightings.size());
    }
    // Places to whole pixels would err by 0.29 px each way.
    CHECK(std::sqrt(squares) < 0.07);
  }
}

TEST_CASE("What is at rest is no moving pattern") {
  CHECK(patterns_in(film([](double, double) { return -1.0; })).empty());
}

TEST_CASE("A second pattern that looks and moves like the first is its twin, other parts of its plate are not") {
  // The one whose first place is the marker's: what lies between two like ones is the same after half a turn too.
  const auto twins_of_marker = [](const std::vector<core::MovingPattern>& found) {
    const auto marker = std::ranges::find_if(found, [](const core::MovingPattern& one) {
      const core::MarkerSighting& first = one.rough.sightings.front();
      return cv::norm(cv::Point2d(first.u_px, first.v_px) - place(first.frame)) < 0.3;
    });
    REQUIRE(marker != found.end());
    return std::ranges::count_if(found, [&](const auto& other) { return core::are_twins(*marker, other); });
  };
  const Look small = [](double x, double y) {
    const double r = std::hypot(x, y);
    return r > 1.5 ? -1.0 : r < 0.33 || (r > 0.66 && r < 1.0) ? 0.05 : 0.8;
  };
  CHECK(twins_of_marker(patterns_in(film(small, -4.0 * kRadius))) >= 1);
  CHECK(twins_of_marker(patterns_in(film(small))) == 0);
  CHECK(twins_of_marker(patterns_in(film(kBullsEye))) == 0);
}
