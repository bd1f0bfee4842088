#include "core/pictures/marker/sphere/still_background.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/core/painter.h"

using namespace glidelab;

TEST_CASE(
    "An object that stays at one place in most frames is not taken for the background if it is known to hide it") {
  const cv::Size size(40, 20);
  constexpr std::size_t kFrames = 30;
  constexpr double kNoise = 2.0;
  core::StillBackground background(kFrames);
  const auto place = [](std::size_t k) { return cv::Point(k < 20 ? 10 : 30, 10); };
  for (std::size_t k = 0; k < kFrames; ++k) {
    cv::Mat image(size, CV_64F, 80.0);
    image(cv::Rect(place(k).x - 3, place(k).y - 3, 7, 7)).setTo(200.0);
    background.add(tests::expose(image, kNoise, 50 + k), k);
  }
  CHECK(background.median().at<unsigned char>(10, 10) > 190);
  const auto hides = [&](std::size_t frame, cv::Point pixel) {
    const cv::Point off = pixel - place(frame);
    return std::abs(off.x) <= 3 && std::abs(off.y) <= 3;
  };
  const auto part = background.behind(cv::Rect(2, 2, 36, 16), hides);
  // Each is the mean of ten codes or more: 6 standard deviations, over 576 pixels.
  const double limit = 6.0 * kNoise / std::sqrt(10.0);
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 36; ++u) {
      REQUIRE(part.known.at<unsigned char>(v, u) != 0);
      CHECK(std::abs(part.codes.at<float>(v, u) - 80.0) < limit);
    }
  }
  // The standard deviation from the mean magnitudes of 18 pixels about their medians is good to a fifth.
  CHECK(std::abs(part.noise / std::hypot(kNoise, 1.0 / std::sqrt(12.0)) - 1.0) < 0.2);
}

TEST_CASE("A pixel that is hidden in all frames but three is not known") {
  core::StillBackground background(10);
  for (std::size_t k = 0; k < 10; ++k) background.add(cv::Mat(8, 8, CV_8U, cv::Scalar(50)), k);
  const auto part = background.behind(cv::Rect(0, 0, 8, 8), [](std::size_t frame, cv::Point pixel) {
    return pixel == cv::Point(4, 4) && frame >= core::StillBackground::kFewest - 1;
  });
  CHECK(part.known.at<unsigned char>(4, 4) == 0);
  CHECK(part.known.at<unsigned char>(4, 5) != 0);
}
