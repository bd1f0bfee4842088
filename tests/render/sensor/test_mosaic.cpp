#include "render/sensor/readout.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab::render;

namespace {

constexpr int kWidth = 64;
constexpr int kHeight = 48;
constexpr PixelRect kAll{0, 0, kWidth, kHeight};
const std::array<float, 4> kAlike = {1.0f, 1.0f, 1.0f, 1.0f};

template <typename Value>
std::vector<std::uint16_t> raw_of(const Value& value) {
  std::vector<std::uint16_t> raw;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) raw.push_back(static_cast<std::uint16_t>(std::lround(value(x, y))));
  }
  return raw;
}

FloatImage grey_of(const std::vector<std::uint16_t>& raw, const std::array<float, 4>& response = kAlike,
                   float offset_dn = 0.0f) {
  return demosaic(raw, kAll, kAll, kWidth, kHeight, response, offset_dn);
}

}  // namespace

TEST_CASE("An even light comes out even, whatever the answers of the colours") {
  const std::array<float, 4> response = mosaic_response({0.5, 1.0, 0.25});
  const FloatImage grey =
      grey_of(raw_of([&](int x, int y) { return 100.0 + 800.0 * response[mosaic_place(x, y)]; }), response, 100.0f);
  // Single precision: a dozen roundings of 800.
  for (const float value : grey.values) CHECK(std::abs(value - 800.0f) < 1e-3f);
}

TEST_CASE("A ramp of light passes unchanged but at the image's edge") {
  const FloatImage grey = grey_of(raw_of([](int x, int y) { return 100.0 + 7.0 * x + 3.0 * y; }));
  for (int y = 1; y < kHeight - 1; ++y) {
    for (int x = 1; x < kWidth - 1; ++x) {
      REQUIRE(std::abs(grey.at(x, y) - static_cast<float>(100 + 7 * x + 3 * y)) < 1e-3f);
    }
  }
}

TEST_CASE("A grey edge between columns is drawn out by the colours, as worked out by hand") {
  // Dark (0) up to column 15, bright (1000) from column 16, which has red in even rows and green in odd ones.
  const FloatImage grey = grey_of(raw_of([](int x, int) { return x < 16 ? 0.0 : 1000.0; }));
  const auto check = [&](int x, int y, double part) { CHECK(std::abs(grey.at(x, y) - 1000.0 * part) < 1e-3); };
  check(14, 10, 0.0);
  check(15, 10, 0.299 / 2.0);                        // a green pixel beside red ones: half of its red is bright
  check(16, 10, 1.0 - (0.587 / 4.0 + 0.114 / 2.0));  // red: a quarter of its green and half of its blue are dark
  check(15, 11, 0.587 / 4.0 + 0.299 / 2.0);          // blue: a quarter of its green, half of its red are bright
  check(16, 11, 1.0 - 0.114 / 2.0);                  // green in a row of blue
  check(17, 10, 1.0);
}

TEST_CASE("Demosaicing agrees with OpenCV's to its rounding of each colour") {
  std::mt19937 random(8);
  std::uniform_int_distribution<int> codes(0, 4000);
  const std::vector<std::uint16_t> raw = raw_of([&](int, int) { return codes(random); });
  const FloatImage grey = grey_of(raw);
  cv::Mat color;
  cv::cvtColor(cv::Mat(kHeight, kWidth, CV_16U, const_cast<std::uint16_t*>(raw.data())), color,
               cv::COLOR_BayerBG2BGR);  // OpenCV names a mosaic by its second row: RGGB is "BG"
  for (int y = 1; y < kHeight - 1; ++y) {
    for (int x = 1; x < kWidth - 1; ++x) {
      const cv::Vec3w bgr = color.at<cv::Vec3w>(y, x);
      const double theirs = 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];
      REQUIRE(std::abs(grey.at(x, y) - theirs) <= 0.76);  // 1/2 of each, but 3/4 where four codes are averaged
    }
  }
}

TEST_CASE("A part of the image is demosaiced as the whole") {
  std::mt19937 random(9);
  std::uniform_int_distribution<int> codes(0, 4000);
  const std::vector<std::uint16_t> raw = raw_of([&](int, int) { return codes(random); });
  const FloatImage whole = grey_of(raw);
  for (const PixelRect& inner :
       {PixelRect{0, 0, 5, 7}, PixelRect{13, 9, 20, 11}, PixelRect{kWidth - 3, kHeight - 4, 3, 4}}) {
    const PixelRect outer = with_neighbours(inner, kWidth, kHeight);
    std::vector<std::uint16_t> part;
    for (int y = outer.y; y < outer.y + outer.height; ++y) {
      for (int x = outer.x; x < outer.x + outer.width; ++x)
        part.push_back(raw[static_cast<std::size_t>(y * kWidth + x)]);
    }
    const FloatImage grey = demosaic(part, outer, inner, kWidth, kHeight, kAlike, 0.0f);
    for (int y = 0; y < inner.height; ++y) {
      for (int x = 0; x < inner.width; ++x) REQUIRE(grey.at(x, y) == whole.at(inner.x + x, inner.y + y));
    }
  }
}
