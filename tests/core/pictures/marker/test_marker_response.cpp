// What a camera that smooths its pixels, and a tone curve, do to the positions of a marker: light is averaged over the
// samples of each pixel, smoothed from pixel to pixel, and goes through the curve, noise and rounding.
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "core/pictures/marker/marker_fit.h"
#include "tests/catch.h"
#include "tests/core/lit_scene.h"

using namespace glidelab;

namespace {

constexpr double kRadius = 8.0;
constexpr int kSide = 33, kWindows = 120;
constexpr double kBlur_px = 0.55;

struct Film {
  double marker, background;  // light
  bool video;                 // pixels are smoothed and the curve is sRGB's; else the lens blurs, and nothing else
  double noise_codes;
};

struct Errors {
  double wave_px = 0.0;  // amplitude of what repeats with the pixel
  double rms_px = 0.0;
};

/// By least squares to cos and sin of the centre's place in the pixel.
Errors errors_of(const std::vector<double>& place, const std::vector<double>& off) {
  Errors errors;
  double mean = 0.0, cosine = 0.0, sine = 0.0;
  const auto count = static_cast<double>(off.size());
  for (const double one : off) mean += one / count;
  for (std::size_t i = 0; i < off.size(); ++i) {  // the places are spread evenly: the terms are orthogonal
    const double phase = 2.0 * std::numbers::pi * place[i];
    cosine += 2.0 / count * (off[i] - mean) * std::cos(phase);
    sine += 2.0 / count * (off[i] - mean) * std::sin(phase);
    errors.rms_px += off[i] * off[i] / count;
  }
  errors.wave_px = std::hypot(cosine, sine);
  errors.rms_px = std::sqrt(errors.rms_px);
  return errors;
}

struct Measured {
  Errors as_codes, corrected;  // the same if there is no response
  std::optional<core::EdgeResponse> response;
};

Measured measure(const Film& film, bool dark) {
  std::vector<core::MarkerWindow> windows;
  std::vector<double> place, plain, corrected;
  std::vector<cv::Point2d> truth;
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int k = 0; k < kWindows; ++k) {
    const cv::Point2d centre(16.0 + (k + 0.5) / kWindows, 16.2 + 0.1 * part(engine));
    const auto light = [&](double u, double v) {
      const double inside = kRadius - std::hypot(u - centre.x, v - centre.y);
      const double share =
          film.video ? (inside > 0.0 ? 1.0 : 0.0) : 0.5 * std::erfc(-inside / (std::sqrt(2.0) * kBlur_px));
      return film.background + (film.marker - film.background) * share;
    };
    cv::Mat image = tests::paint({kSide, kSide}, light, 24);
    if (film.video) {
      cv::GaussianBlur(image, image, {5, 5}, kBlur_px);
      image.forEach<double>([](double& pixel, const int*) { pixel = tests::srgb_of_light(pixel); });
    }
    cv::Mat codes = tests::expose(255.0 * image, film.noise_codes, 100U + static_cast<unsigned>(k));
    if (dark) cv::bitwise_not(codes, codes);
    core::MarkerGuess guess;
    guess.centre = centre;
    guess.radius_px = kRadius;
    core::MarkerWindow window{core::Signal{codes, {}, dark}, {k % 7, k % 5}, guess};
    const auto fit = core::fit_marker(window.signal, guess, core::Surface::uniform);
    REQUIRE(fit);
    window.guess.centre = fit->centre;
    window.guess.blur_px = fit->blur_px;
    window.guess.shape = fit->shape;
    windows.push_back(window);
    truth.push_back(centre);
    place.push_back(centre.x);
    plain.push_back(fit->centre.x - centre.x);
  }
  Measured measured{errors_of(place, plain), errors_of(place, plain),
                    core::marker_response(windows, core::Surface::uniform, true)};
  if (!measured.response) return measured;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const auto fit = core::fit_marker(windows[k], core::Surface::uniform, *measured.response);
    REQUIRE(fit);
    corrected.push_back(fit->centre.x - truth[k].x);
  }
  measured.corrected = errors_of(place, corrected);
  return measured;
}

}  // namespace

TEST_CASE("the waves that a tone curve makes are taken off in ordinary noise, of a bright marker and of a dark one") {
  // A position's noise is 0.005 px, so that of an amplitude from 120 of them 0.005 sqrt(2 / 120) = 0.0007 px.
  const Measured bright = measure({0.82, 0.05, true, 1.7}, false);
  CHECK(bright.as_codes.wave_px > 0.006);
  REQUIRE(bright.response);
  CHECK(bright.response->tone == core::ToneCurve::srgb);
  CHECK(bright.corrected.wave_px < 0.0025);
  const Measured dark = measure({0.04, 0.42, true, 1.7}, true);
  CHECK(dark.as_codes.wave_px > 0.006);
  REQUIRE(dark.response);
  CHECK(dark.response->tone == core::ToneCurve::srgb);
  CHECK(dark.corrected.wave_px < 0.0025);
}

TEST_CASE("positions of a linear camera without a mosaic are not made worse, in little noise or in much") {
  for (const double noise : {0.2, 1.0, 4.0}) {
    INFO("noise of " << noise << " codes");
    const Measured linear = measure({0.82, 0.16, false, noise}, false);
    CHECK((!linear.response || linear.response->tone == core::ToneCurve::linear));
    // The rounding of codes and the samples leave 0.0003 px.
    CHECK(linear.corrected.rms_px < 1.03 * linear.as_codes.rms_px + 0.0003);
  }
}
