#include "render/sensor/readout.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab::render;

namespace {

constexpr int kWidth = 203;
constexpr int kHeight = 90;
constexpr double kExposure = 0.01;

FloatImage flat(float value, int width = kWidth, int height = kHeight) {
  FloatImage image(width, height);
  std::fill(image.values.begin(), image.values.end(), value);
  return image;
}

FloatImage slope(double most_e) {
  FloatImage image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) image.at(x, y) = static_cast<float>(most_e * (x + y) / (kWidth + kHeight));
  }
  return image;
}

template <typename Code>
std::vector<Code> codes_of(const Readout& readout, const FloatImage& image, std::uint32_t frame = 0,
                           PixelRect rect = {}) {
  if (rect.empty()) rect = {0, 0, image.width, image.height};
  std::vector<Code> codes(static_cast<std::size_t>(rect.width) * rect.height);
  readout.read(image, 3, frame, rect, std::span<Code>(codes));
  return codes;
}

/// One code an electron.
Sensor counting_sensor() {
  return {.bit_depth = 16, .full_well_e = 60000.0, .read_noise_e = 0.0, .gain_dn_per_e = 1.0, .offset_dn = 0.0};
}

Sensor with_everything() {
  Sensor sensor;
  sensor.converter_bits = 10;
  sensor.full_well_e = 5000.0;
  sensor.read_noise_e = 4.0;
  sensor.gain_dn_per_e = 0.19;
  sensor.offset_dn = 16.0;
  sensor.pixels = {30.0, 0.01, 2.0, 0.001, 1e4, 0.001};
  sensor.tone.kind = ToneCurve::Kind::bt709;
  sensor.colour = Colour::bayer;
  return sensor;
}

}  // namespace

TEST_CASE("At low light the electrons that are read out follow Poisson's distribution exactly") {
  // Chi-square against the exact probabilities over the counts of which 10 or more are expected, and the rest as one
  // class. Limit: the 99.99 % quantile of f degrees by Wilson and Hilferty, f (1 - 2/(9f) + 3.72 sqrt(2/(9f)))³.
  for (const double mean : {0.2, 1.0, 4.5, 30.0, 200.0, 255.5}) {
    std::map<int, double> seen;
    const double draws = 480'000.0;
    const Readout readout(counting_sensor(), kExposure, 77, 800, 600);
    for (const std::uint16_t code : codes_of<std::uint16_t>(readout, flat(static_cast<float>(mean), 800, 600))) {
      ++seen[code];
    }
    double chi2 = 0.0;
    double left = draws;
    double left_seen = draws;
    int classes = 0;
    for (int k = 0; k < 400; ++k) {
      const double expected =
          draws * std::exp(k * std::log(static_cast<double>(static_cast<float>(mean))) - mean - std::lgamma(k + 1.0));
      if (expected < 10.0) continue;
      chi2 += (seen[k] - expected) * (seen[k] - expected) / expected;
      left -= expected;
      left_seen -= seen[k];
      ++classes;
    }
    if (left > 1.0) chi2 += (left_seen - left) * (left_seen - left) / left;
    const double f = classes;
    CAPTURE(mean, chi2, f);
    CHECK(chi2 < f * std::pow(1.0 - 2.0 / (9.0 * f) + 3.72 * std::sqrt(2.0 / (9.0 * f)), 3.0));
  }
}

TEST_CASE("Dark electrons add to those of the light, and their sum is Poisson's too") {
  Sensor sensor = counting_sensor();
  sensor.pixels.dark_signal_e_s = 500.0;  // 5 in the exposure
  const auto codes = codes_of<std::uint16_t>(Readout(sensor, kExposure, 1, 800, 600), flat(2.0f, 800, 600));
  double mean = 0.0, variance = 0.0;
  for (const std::uint16_t code : codes) mean += code / 480'000.0;
  for (const std::uint16_t code : codes) variance += (code - mean) * (code - mean) / 480'000.0;
  // Standard errors of mean and variance of Poisson(7): sqrt(7/n) and sqrt((2 * 49 + 7)/n); 4.5 of them.
  CHECK(std::abs(mean - 7.0) < 4.5 * std::sqrt(7.0 / 480'000.0));
  CHECK(std::abs(variance - 7.0) < 4.5 * std::sqrt(105.0 / 480'000.0));
}

TEST_CASE("The mean of a pixel over frames is its response times the light, and its own dark and offset") {
  Sensor sensor = counting_sensor();
  sensor.offset_dn = 300.0;
  sensor.read_noise_e = 5.0;
  sensor.pixels = {1000.0, 0.05, 30.0, 0.0, 0.0, 0.02};
  for (const float light : {40.0f, 3000.0f}) {  // the exact way, and the normal one
    const Readout readout(sensor, kExposure, 5, kWidth, kHeight);
    const FixedPattern pattern = make_fixed_pattern(sensor.pixels, kExposure, 5, kWidth, kHeight);
    std::vector<double> mean(static_cast<std::size_t>(kWidth) * kHeight, 0.0);
    constexpr int kFrames = 100;
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
      const auto codes = codes_of<std::uint16_t>(readout, flat(light), frame);
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += codes[i] / static_cast<double>(kFrames);
    }
    // chi² of the standardised means over all pixels, 18,270 degrees of freedom: 4.5 standard deviations sqrt(2 f).
    double chi2 = 0.0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double electrons = light * pattern.response[i] + pattern.dark_e[i];
      const double z2 =
          std::pow(mean[i] - 300.0 - electrons - pattern.offset_e[i], 2) / ((electrons + 25.0 + 1.0 / 12.0) / kFrames);
      chi2 += z2;
    }
    const auto f = static_cast<double>(mean.size());
    CAPTURE(light, chi2, f);
    CHECK(std::abs(chi2 - f) < 4.5 * std::sqrt(2.0 * f));
  }
}

TEST_CASE("A tone curve turns the converter's codes into those of the video") {
  Sensor sensor = with_everything();
  sensor.colour = Colour::mono;
  sensor.pixels = {};
  Sensor plain = sensor;
  plain.bit_depth = 10;
  plain.tone = {};
  const FloatImage image = slope(6000.0);
  const auto linear = codes_of<std::uint16_t>(Readout(plain, kExposure, 9, kWidth, kHeight), image);
  const auto video = codes_of<std::uint8_t>(Readout(sensor, kExposure, 9, kWidth, kHeight), image);
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double x = std::max(0.0, (linear[i] - 16.0) / (1023.0 - 16.0));
    const double y = x < 0.018 ? 4.5 * x : 1.099 * std::pow(x, 0.45) - 0.099;
    REQUIRE(std::abs(video[i] - 255.0 * y) <= 0.5 + 1e-9);
  }
}

TEST_CASE("A converter of more bits without a tone curve is divided down") {
  Sensor sensor = counting_sensor();
  sensor.bit_depth = 8;
  sensor.converter_bits = 12;
  sensor.offset_dn = 64.0;
  const auto codes = codes_of<std::uint8_t>(Readout(sensor, kExposure, 9, kWidth, kHeight), flat(0.0f));
  CHECK(std::all_of(codes.begin(), codes.end(), [](int code) { return code == 4; }));  // 64 * 255/4095 = 3.99
}

TEST_CASE("The level of white is found back through the tone curve") {
  Sensor sensor = with_everything();
  for (const double code : {20.0, 128.0, 200.0, 255.0}) {
    const double x = (converter_code(sensor, code) - 16.0) / (1023.0 - 16.0);
    CHECK(std::abs(sensor.tone(x) * 255.0 - code) < 1e-9);
  }
  CHECK(converter_code(Sensor{}, 191.25) == 191.25);
}

TEST_CASE("A mosaic behind white balance shows the same grey, with the noise of the weaker colours") {
  Sensor sensor = counting_sensor();
  sensor.offset_dn = 200.0;
  sensor.colour = Colour::bayer;
  sensor.colour_response = {0.5, 1.0, 0.25};
  const auto codes = codes_of<std::uint16_t>(Readout(sensor, kExposure, 2, 800, 600), flat(4000.0f, 800, 600));
  double mean = 0.0;
  double red_square = 0.0;
  double reds = 0.0;
  for (std::size_t i = 0; i < codes.size(); ++i) mean += codes[i] / 480'000.0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::size_t x = i % 800, y = i / 800;
    if (x % 2 != 0 || y % 2 != 0 || x == 0 || y == 0) continue;
    red_square += (codes[i] - 4200.0) * (codes[i] - 4200.0);
    ++reds;
  }
  // White balance leaves 4000/r electrons of variance in a colour of answer r; at a red pixel grey is 0.299 R (one
  // pixel), 0.587 of the mean of 4 G, 0.114 of the mean of 4 B; and it is rounded.
  const double variance =
      4000.0 * (0.299 * 0.299 / 0.5 + 0.587 * 0.587 / 4.0 + 0.114 * 0.114 / 4.0 / 0.25) + 1.0 / 12.0;
  CHECK(std::abs(red_square / reds - variance) < 4.5 * variance * std::sqrt(2.0 / reds));
  // Neighbours share pixels, so the mean's error is that of the pixels: with weights of 1 on average, 4000 <1/r> a
  // pixel.
  CHECK(std::abs(mean - 4200.0) < 4.5 * std::sqrt(4000.0 * 4.0 / 480'000.0));
}

TEST_CASE("A part of the image has the codes of the whole with every effect switched on") {
  const FloatImage image = slope(6000.0);
  const Readout readout(with_everything(), kExposure, 7, kWidth, kHeight);
  const auto whole = codes_of<std::uint8_t>(readout, image, 4);
  for (const PixelRect& rect : {PixelRect{0, 0, 33, 20}, PixelRect{31, 17, 64, 40}, PixelRect{150, 60, 53, 30}}) {
    const auto part = codes_of<std::uint8_t>(readout, image, 4, rect);
    for (int y = 0; y < rect.height; ++y) {
      for (int x = 0; x < rect.width; ++x) {
        REQUIRE(part[static_cast<std::size_t>(y * rect.width + x)] ==
                whole[static_cast<std::size_t>((rect.y + y) * kWidth + rect.x + x)]);
      }
    }
  }
  CHECK(codes_of<std::uint8_t>(readout, image, 4) == whole);
  CHECK(codes_of<std::uint8_t>(Readout(with_everything(), kExposure, 8, kWidth, kHeight), image, 4) != whole);
}

TEST_CASE("A sensor without patterns, colours and tone gives the codes that read_out gives") {
  const Sensor sensor;
  const FloatImage image = slope(70000.0);
  std::vector<std::uint8_t> direct(static_cast<std::size_t>(kWidth) * kHeight);
  read_out(sensor, image, {6, 3, 2}, {0, 0, kWidth, kHeight}, std::span<std::uint8_t>(direct));
  CHECK(codes_of<std::uint8_t>(Readout(sensor, kExposure, 6, kWidth, kHeight), image, 2) == direct);
}

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
