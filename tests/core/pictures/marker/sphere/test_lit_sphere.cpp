#include "core/pictures/marker/sphere/lit_sphere.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "tests/catch.h"
#include "tests/core/lit_scene.h"

using namespace glidelab;

namespace {

constexpr double kRadius = 7.0;
constexpr double kNoise = 1.5;    // codes
constexpr double kBehind = 0.12;  // the light of the wall and of the unlit side of the ball

std::vector<core::SpherePixel> pixels_of(const cv::Mat& image, double behind) {
  std::vector<core::SpherePixel> pixels;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      pixels.push_back(
          {static_cast<double>(u), static_cast<double>(v), image.at<unsigned char>(v, u) / 255.0, behind, 1.0});
    }
  }
  return pixels;
}

core::SphereGuess guess_at(cv::Point2d centre, core::ToneCurve tone) {
  core::SphereGuess guess;
  guess.centre = centre;
  guess.shape = {1.0 / kRadius, 0.0, 1.0 / kRadius};
  guess.log_size_sd = 2e-3;
  guess.blur_px = 0.05;
  guess.tone = tone;
  guess.noise = kNoise / 255.0;
  return guess;
}

/// A ball whose unlit side cannot be told from the wall.
tests::LitBall side_lit(cv::Point2d centre) {
  tests::LitBall ball;
  ball.centre = centre;
  ball.radius_px = kRadius;
  ball.lamp_x = -0.5;
  ball.lamp_y = -0.2;
  ball.lamp_z = 0.3;
  ball.ambient = kBehind;
  return ball;
}

cv::Mat image_of(const tests::LitBall& ball, bool srgb, std::uint64_t seed, double noise = kNoise) {
  return tests::expose_light(
      {25, 25}, [&](double u, double v) { return tests::light_of(ball, u, v, kBehind); }, srgb, noise, seed);
}

/// The centroid of what is brighter than the wall.
double centroid_u(const cv::Mat& image) {
  const double wall = 255.0 * tests::srgb_of_light(kBehind);
  double sum = 0.0, sum_u = 0.0;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double above = std::max(0.0, image.at<unsigned char>(v, u) - wall - 6.0 * kNoise);
      sum += above;
      sum_u += above * u;
    }
  }
  return sum_u / sum;
}

}  // namespace

TEST_CASE("A sphere whose unlit side looks like the wall is found at its centre, not where it is bright") {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> part(-0.5, 0.5);
  constexpr int kFrames = 40;
  double squares = 0.0, sum_u = 0.0, sd = 0.0;
  for (int k = 0; k < kFrames; ++k) {
    const cv::Point2d centre(12.0 + part(engine), 12.0 + part(engine));
    const cv::Mat image = image_of(side_lit(centre), true, 100 + static_cast<std::uint64_t>(k));
    const auto fit = core::fit_lit_sphere(pixels_of(image, kBehind),
                                          guess_at(centre + cv::Point2d(0.6, -0.4), core::ToneCurve::srgb));
    REQUIRE(fit);
    const cv::Point2d off = fit->centre - centre;
    squares += off.dot(off) / (fit->sd_px * fit->sd_px);
    sum_u += off.x;
    sd = fit->sd_px;
    CHECK(std::abs(centroid_u(image) - centre.x) > 1.0);
  }
  CHECK(sd < 0.02);
  // The mean of 2 x 40 squared errors over their variance has the mean 1 and the standard deviation sqrt(2/80) = 0.16.
  // The limits 0.5 and 1.6 are 3.2 and 3.8 standard deviations away, the upper with room for the kink at the edge of
  // the shadow.
  const double per_coordinate = squares / (2.0 * kFrames);
  CHECK(per_coordinate > 0.5);
  CHECK(per_coordinate < 1.6);
  // No bias: the mean of 40 lies within 4 standard deviations, plus a hundredth of a pixel for the finite samples of
  // the rim.
  CHECK(std::abs(sum_u / kFrames) < 4.0 * sd / std::sqrt(double{kFrames}) + 0.01);
}

TEST_CASE("The wrong tone curve leaves larger residuals") {
  for (const bool srgb : {false, true}) {
    const cv::Mat image = image_of(side_lit({12.2, 11.9}), srgb, 7);
    const auto pixels = pixels_of(image, kBehind);
    // With another tone curve, the same codes of the wall mean another light.
    auto pixels_linear = pixels;
    const double code = srgb ? tests::srgb_of_light(kBehind) : kBehind;
    for (auto& pixel : pixels_linear) pixel.behind = code;
    auto pixels_srgb = pixels;
    for (auto& pixel : pixels_srgb) pixel.behind = core::light_of_code(core::ToneCurve::srgb, code);
    const auto by_linear = core::fit_lit_sphere(pixels_linear, guess_at({12.0, 12.0}, core::ToneCurve::linear));
    const auto by_srgb = core::fit_lit_sphere(pixels_srgb, guess_at({12.0, 12.0}, core::ToneCurve::srgb));
    REQUIRE(by_linear);
    REQUIRE(by_srgb);
    const double right = srgb ? by_srgb->rms : by_linear->rms, wrong = srgb ? by_linear->rms : by_srgb->rms;
    CHECK(wrong > 1.3 * right);
    // Noise and rounding (1/12), known to 3 % from 600 pixels, and a tenth more for residuals at the edge of the
    // shadow.
    CHECK(right * 255.0 < 1.15 * std::sqrt(kNoise * kNoise + 1.0 / 12.0));
  }
}

TEST_CASE("A disc is fitted at its centre, as a flat marker without a lamp") {
  tests::LitBall disc = side_lit({12.3, 11.8});
  disc.is_disc = true;
  disc.ambient = 0.6;
  core::SphereGuess guess = guess_at({12.0, 12.0}, core::ToneCurve::srgb);
  guess.flat = true;
  const auto fit = core::fit_lit_sphere(pixels_of(image_of(disc, true, 3), kBehind), guess);
  REQUIRE(fit);
  CHECK(std::abs(fit->light.ambient - 0.6) < 0.01);
  CHECK(std::abs(fit->light.lamp[2]) < 1e-3);
  // Its light has no slope. 150 pixels with a noise of 1.5 codes determine it to 5e-3, where the slope of the tone
  // curve is 0.53.
  CHECK(std::hypot(fit->light.lamp[0], fit->light.lamp[1]) < 0.02);
  CHECK(cv::norm(fit->centre - disc.centre) < 4.0 * fit->sd_px + 0.005);
}

TEST_CASE("sRGB codes and light turn into each other") {
  for (const double light : {0.0, 0.001, 0.02, 0.3, 0.99, 1.0}) {
    CHECK(std::abs(core::code_of_light(core::ToneCurve::srgb, light) - tests::srgb_of_light(light)) < 1e-12);
    CHECK(std::abs(core::light_of_code(core::ToneCurve::srgb, tests::srgb_of_light(light)) - light) < 1e-6);
  }
}
