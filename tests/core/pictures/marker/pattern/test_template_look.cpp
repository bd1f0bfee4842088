#include "core/pictures/marker/pattern/template_look.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tests/catch.h"
#include "tests/core/clip_in_memory.h"
#include "tests/core/painter.h"

using namespace glidelab;

namespace {

const cv::Size kSize(250, 48);
constexpr std::size_t kFrames = 44;
constexpr double kRadius = 8.3;

cv::Point2d place(std::size_t k) {
  const double t = static_cast<double>(k);
  return {212.4 - 5.17 * t + 0.031 * t * t, 24.2 + 0.173 * t / 4.0};
}

/// Quadrants with sharp edges on a grey wall, averaged over each pixel, with a noise of one code.
std::vector<cv::Mat> film_quadrants() {
  std::vector<cv::Mat> frames;
  for (std::size_t k = 0; k < kFrames; ++k) {
    const auto light = [&](double u, double v) {
      const double x = (u - place(k).x) / kRadius, y = (v - place(k).y) / kRadius;
      if (std::hypot(x, y) < 1.0) return x * y > 0.0 ? 30.0 : 220.0;
      return std::abs(x) < 1.8 && std::abs(y) < 1.8 ? 220.0 : 120.0;
    };
    frames.push_back(tests::expose(tests::paint(kSize, light, 8), 1.0, 3100 + k));
  }
  return frames;
}

/// Places that err alike wherever the marker lies alike in its pixels: by a sine of their part below a pixel.
core::TrackedMarker guesses(double amplitude_px) {
  core::TrackedMarker rough;
  for (std::size_t k = 0; k < kFrames; ++k) {
    core::MarkerFit fit;
    fit.centre = place(k);
    fit.centre.x += amplitude_px * std::sin(2.0 * std::numbers::pi * place(k).x);
    rough.sightings.push_back({k, fit.centre.x, fit.centre.y, 0.5, kRadius});
    rough.fits.push_back(fit);
  }
  return rough;
}

}  // namespace

TEST_CASE("guesses that err with the part of a place below a pixel leave no such error in the path") {
  constexpr double kAmplitude_px = 0.15;
  const std::vector<cv::Mat> frames = film_quadrants();
  const core::ClipAgain clip{[&] { return std::make_unique<tests::ClipInMemory>(frames); }, frames.size()};
  const core::ShapeAt circle = [](cv::Point2d, core::MarkerBody) {
    return std::optional(cv::Vec3d(1.0, 0.0, 1.0) / kRadius);
  };
  const core::TrackedMarker rough = guesses(kAmplitude_px);
  const auto found = core::look_by_template(rough, core::windows_around(rough, clip, circle), circle);
  REQUIRE(found);
  REQUIRE(found->sightings.size() + 1 >= kFrames);
  double left = 0.0, squares = 0.0;
  for (const core::MarkerSighting& sighting : found->sightings) {
    const double sine = std::sin(2.0 * std::numbers::pi * place(sighting.frame).x);
    left += sine * (sighting.u_px - place(sighting.frame).x);
    squares += sine * sine;
  }
  // Edges of 190 codes, 30 px of them across the motion, with a noise of one code give 0.001 px. The grid of the look
  // and the pixels, which are wider than the edges, leave more: a sixth of the error of the guesses is allowed.
  CHECK(std::abs(left / squares) < kAmplitude_px / 6.0);
}
