#include "core/pictures/marker/marker_fit.h"

#include <cmath>
#include <numbers>

#include "tests/catch.h"
#include "tests/core/painter.h"

using namespace glidelab;

namespace {

constexpr double kNoise = 2.0, kLevel = 80.0, kAmplitude = 120.0;
const cv::Size kSize(41, 41);

cv::Mat image_of(cv::Point2d centre, double radius, double blur_px, int samples) {
  return tests::paint(
      kSize,
      [&](double u, double v) {
        const double s = radius - std::hypot(u - centre.x, v - centre.y);
        const double share = blur_px > 0.0 ? 0.5 * std::erfc(-s / (std::numbers::sqrt2 * blur_px))
                             : s > 0.0     ? 1.0
                                           : 0.0;
        return kLevel + kAmplitude * share;
      },
      samples);
}

core::MarkerGuess guess_of(cv::Point2d centre, double radius, double blur_px) {
  core::MarkerGuess guess;
  guess.centre = centre + cv::Point2d(0.2, -0.2);
  guess.radius_px = radius;
  guess.blur_px = std::max(blur_px, 0.15);
  return guess;
}

}  // namespace

TEST_CASE("the bound of a large disc is that of the length of its rim") {
  // The mean of cos^2 over the normals of the rim is 1/2, so the information is pi R A^2 / s^2 times the integral of
  // E'^2, which is 1 / (2 b sqrt(pi)) for a Gaussian edge of standard deviation b. With a blur of 1.5 px, the pixel
  // only adds 1/12 to b^2. The slope of the background costs the overlap of an odd pattern with it.
  const double radius = 15.0, blur = 1.5;
  const double b = std::sqrt(blur * blur + 1.0 / 12.0);
  const double information =
      std::numbers::pi * radius * kAmplitude * kAmplitude / (kNoise * kNoise) / (2.0 * b * std::sqrt(std::numbers::pi));
  const double bound = core::least_centre_sd_px({0.3, 0.1, radius, blur, kAmplitude, kNoise}, 60.0);
  CHECK(bound * std::sqrt(information) > 0.99);
  CHECK(bound * std::sqrt(information) < 1.02);
}

TEST_CASE("the centre's variance is within 1.2 of the Cramer-Rao bound") {
  for (const double radius : {3.0, 5.0, 9.0}) {
    for (const double blur_px : {0.3, 0.6}) {
      const cv::Point2d centre(20.37, 20.61);
      const cv::Mat image = image_of(centre, radius, blur_px, 16);
      double squares = 0.0;
      cv::Point2d sum;
      constexpr int kTrials = 400;
      for (int k = 0; k < kTrials; ++k) {
        const core::Signal noisy{tests::expose(image, kNoise, static_cast<std::uint64_t>(1000 + k))};
        const auto fit = core::fit_marker(noisy, guess_of(centre, radius, blur_px), core::Surface::uniform);
        REQUIRE(fit);
        const cv::Point2d off = fit->centre - centre;
        sum += off;
        squares += off.dot(off);
      }
      const double variance = 0.5 * (squares - sum.dot(sum) / kTrials) / (kTrials - 1);
      const double noise = std::sqrt(kNoise * kNoise + 1.0 / 12.0);  // including the rounding to grey values
      const double bound =
          core::least_centre_sd_px({centre.x, centre.y, radius, blur_px, kAmplitude, noise}, 1.25 * radius + 2.5);
      const double ratio = variance / (bound * bound);
      INFO("radius " << radius << ", blur " << blur_px << ": variance over the bound " << ratio << ", sd "
                     << std::sqrt(variance) << " px, mean off " << cv::norm(sum) / kTrials);
      // 800 coordinates: the variance scatters by 5 %; three of these on either side.
      CHECK(ratio < 1.2 * 1.15);
      CHECK(ratio > 0.85);
    }
  }
}

TEST_CASE("the centre's bias is below 0.005 px at every phase of the pixels") {
  for (const double radius : {3.0, 5.0, 9.0}) {
    for (const double blur_px : {0.2, 0.5, 0.9}) {
      double worst = 0.0;
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 4; ++i) {
          const cv::Point2d centre(20.0 + 0.25 * i + 0.03, 20.0 + 0.25 * j + 0.07);
          const cv::Mat image = 200.0 * image_of(centre, radius, blur_px, 16);
          const auto fit = core::fit_marker({tests::expose(image, 0.0, 1, CV_16U)}, guess_of(centre, radius, blur_px),
                                            core::Surface::uniform);
          REQUIRE(fit);
          worst = std::max(worst, cv::norm(fit->centre - centre));
        }
      }
      INFO("radius " << radius << ", blur " << blur_px << ": worst bias " << worst << " px");
      CHECK(worst < 0.005);
    }
  }
}
