#include "render/sensor/sensor.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "tests/catch.h"

using namespace glidelab::render;

namespace {

FloatImage flat(int width, int height, float value) {
  FloatImage image(width, height);
  std::fill(image.values.begin(), image.values.end(), value);
  return image;
}

/// All levels side by side: dark enough for the exact path, and up to beyond the full well.
FloatImage all_levels(int width, int height, double full_well) {
  FloatImage image(width, height);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = static_cast<float>(1.1 * full_well * static_cast<double>((i * 7919) % 1000) / 1000.0);
  }
  return image;
}

template <typename Code>
std::vector<Code> codes_of(const Sensor& sensor, const FloatImage& image, const NoiseKey& key, PixelRect rect = {},
                           Simd simd = Simd::best) {
  if (rect.empty()) rect = {0, 0, image.width, image.height};
  std::vector<Code> codes(static_cast<std::size_t>(rect.width) * rect.height);
  read_out(sensor, image, key, rect, std::span<Code>(codes), simd);
  return codes;
}

struct Sample {
  double mean = 0.0, variance = 0.0, third = 0.0, fourth = 0.0;
};

template <typename Code>
Sample sample_of(const std::vector<Code>& codes) {
  Sample sample;
  const auto n = static_cast<double>(codes.size());
  for (const Code code : codes) sample.mean += code / n;
  for (const Code code : codes) {
    const double d = code - sample.mean;
    sample.variance += d * d / n;
    sample.third += d * d * d / n;
    sample.fourth += d * d * d * d / n;
  }
  return sample;
}

/// 16 bits at one code an electron: nothing but the noise itself.
Sensor counting_sensor() {
  return {.bit_depth = 16, .full_well_e = 60000.0, .read_noise_e = 20.0, .gain_dn_per_e = 1.0, .offset_dn = 200.0};
}

}  // namespace

TEST_CASE("Mean and variance of the codes are those of the photon transfer, dark and bright") {
  // Of n = 480,000 pixels the mean errs by sigma/sqrt(n), the variance by sqrt((mu4 - sigma⁴)/n); 4.5 of them,
  // two-sided 7e-6 a test. Rounding to a code adds 1/12 to the variance.
  const Sensor sensor = counting_sensor();
  const double n = 480'000.0;
  std::uint32_t stream = 0;
  for (const double electrons : {0.0, 0.4, 3.0, 40.0, 255.0, 257.0, 1000.0, 30000.0}) {
    const FloatImage image = flat(800, 600, static_cast<float>(electrons));
    const Sample sample = sample_of(codes_of<std::uint16_t>(sensor, image, {11, stream++, 3}));
    const double variance = electrons + 400.0 + 1.0 / 12.0;
    CAPTURE(electrons);
    CHECK(std::abs(sample.mean - 200.0 - electrons) < 4.5 * std::sqrt(variance / n));
    CHECK(std::abs(sample.variance - variance) <
          4.5 * std::sqrt((sample.fourth - sample.variance * sample.variance) / n));
  }
}

TEST_CASE("The noise is normal where it is said to be, and Poisson's skewness is there below") {
  const double n = 480'000.0;
  Sensor sensor = counting_sensor();
  const auto bright = sample_of(codes_of<std::uint16_t>(sensor, flat(800, 600, 20000.0f), {5, 1, 1}));
  const double sigma = std::sqrt(bright.variance);
  // Standard errors of skewness and kurtosis of a normal sample: sqrt(6/n), sqrt(24/n).
  CHECK(std::abs(bright.third / (sigma * sigma * sigma)) < 4.5 * std::sqrt(6.0 / n));
  CHECK(std::abs(bright.fourth / (bright.variance * bright.variance) - 3.0) < 4.5 * std::sqrt(24.0 / n));
  sensor.read_noise_e = 0.0;
  const auto dark = sample_of(codes_of<std::uint16_t>(sensor, flat(800, 600, 4.0f), {5, 2, 1}));
  // Skewness 1/sqrt(4); its standard error for this distribution is below 4 sqrt(6/n).
  CHECK(std::abs(dark.third / std::pow(dark.variance, 1.5) - 0.5) < 4.5 * 4.0 * std::sqrt(6.0 / n));
}

TEST_CASE("Pixels, frames and streams are not correlated") {
  // The correlation of n independent pairs has a standard deviation of 1/sqrt(n) = 1.4e-3; 4.5 of them.
  const Sensor sensor = counting_sensor();
  const FloatImage image = flat(800, 600, 5000.0f);
  const auto base = codes_of<std::uint16_t>(sensor, image, {1, 1, 1});
  const auto correlation = [&](const std::vector<std::uint16_t>& other, std::size_t lag) {
    const Sample a = sample_of(base);
    const Sample b = sample_of(other);
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < base.size(); ++i) sum += (base[i] - a.mean) * (other[i + lag] - b.mean);
    return sum / static_cast<double>(base.size() - lag) / std::sqrt(a.variance * b.variance);
  };
  const double limit = 4.5 / std::sqrt(480'000.0);
  for (const std::size_t lag : {1u, 2u, 4u, 8u, 16u, 24u, 32u, 256u, 800u})
    CHECK(std::abs(correlation(base, lag)) < limit);
  for (const NoiseKey& key :
       {NoiseKey{1, 1, 2}, NoiseKey{1, 2, 1}, NoiseKey{2, 1, 1}, NoiseKey{1ull << 32 | 1, 1, 1}}) {
    CHECK(std::abs(correlation(codes_of<std::uint16_t>(sensor, image, key), 0)) < limit);
  }
  CHECK(codes_of<std::uint16_t>(sensor, image, {1, 1, 1}) == base);
}

TEST_CASE("Every way to compute a pixel gives the same code") {
  for (const int width : {800, 801, 64, 33, 7}) {
    const Sensor sensor{};
    const FloatImage image = all_levels(width, 50, sensor.full_well_e);
    const NoiseKey key{99, 4, 12};
    const auto best = codes_of<std::uint8_t>(sensor, image, key);
    CHECK(codes_of<std::uint8_t>(sensor, image, key, {}, Simd::baseline) == best);
    CHECK(codes_of<std::uint8_t>(sensor, image, key, {}, Simd::portable) == best);
    const auto deep = codes_of<std::uint16_t>(sensor, image, key);
    CHECK(std::equal(best.begin(), best.end(), deep.begin()));
  }
}

TEST_CASE("A part of the image has the codes of the whole, in any order and on any thread") {
  const Sensor sensor{};
  const FloatImage image = all_levels(203, 90, sensor.full_well_e);
  const NoiseKey key{7, 0, 5};
  const auto whole = codes_of<std::uint8_t>(sensor, image, key);
  std::vector<PixelRect> parts;
  for (int y = 0; y < 90; y += 17) {
    for (int x = 0; x < 203; x += 29) {
      parts.push_back(intersection({x, y, 29, 17}, {0, 0, 203, 90}));
    }
  }
  std::shuffle(parts.begin(), parts.end(), std::mt19937(3));
  std::vector<std::uint8_t> together(whole.size());
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < 3; ++t) {
      threads.emplace_back([&, t] {
        for (std::size_t i = t; i < parts.size(); i += 3) {
          const PixelRect& part = parts[i];
          const auto codes = codes_of<std::uint8_t>(sensor, image, key, part);
          for (int y = 0; y < part.height; ++y) {
            std::copy_n(codes.begin() + y * part.width, part.width, together.begin() + (part.y + y) * 203 + part.x);
          }
        }
      });
    }
  }
  CHECK(together == whole);
}

TEST_CASE("Codes saturate at the full well and at the largest code, never wrap") {
  // Full well at half the codes: offset 10 + 0.5 * 30000/... the clip comes before the read noise, which stays.
  const Sensor sensor{
      .bit_depth = 12, .full_well_e = 2000.0, .read_noise_e = 3.0, .gain_dn_per_e = 1.0, .offset_dn = 100.0};
  const auto over = sample_of(codes_of<std::uint16_t>(sensor, flat(400, 300, 50000.0f), {1, 0, 0}));
  // Mean 2100, variance 9 + 1/12: all charge above the well is lost.
  CHECK(std::abs(over.mean - 2100.0) < 4.5 * std::sqrt(9.1 / 120000.0));
  CHECK(std::abs(over.variance - 9.0 - 1.0 / 12.0) < 4.5 * std::sqrt(2.0 * 9.1 * 9.1 / 120000.0));
  const Sensor narrow{
      .bit_depth = 8, .full_well_e = 1e6, .read_noise_e = 100.0, .gain_dn_per_e = 0.01, .offset_dn = 1.0};
  const auto white = codes_of<std::uint8_t>(narrow, flat(100, 100, 90000.0f), {1, 0, 0});
  CHECK(std::count(white.begin(), white.end(), 255) == 10000);
  // Dark, with read noise of one code about the offset of 1: what would be negative is 0.
  const auto black = codes_of<std::uint8_t>(narrow, flat(100, 100, 0.0f), {1, 0, 0});
  CHECK(*std::max_element(black.begin(), black.end()) < 8);
  CHECK(std::count(black.begin(), black.end(), 0) > 2000);
}

TEST_CASE("Light just below the full well loses what the well cuts off the photons' scatter") {
  // E min(X, W) of X = N(m, m) is W - s (phi(d) + d Phi(d)), d = (W - m)/s, s = sqrt(m).
  const Sensor sensor{
      .bit_depth = 16, .full_well_e = 10000.0, .read_noise_e = 0.0, .gain_dn_per_e = 1.0, .offset_dn = 200.0};
  for (const double below_sd : {3.0, 1.0, 0.0, -1.0}) {
    const double mean = sensor.full_well_e - below_sd * 100.0, s = std::sqrt(mean);
    const double d = (sensor.full_well_e - mean) / s;
    const double density = std::exp(-0.5 * d * d) / std::sqrt(2.0 * std::acos(-1.0));
    const double below = 0.5 * std::erfc(-d / std::sqrt(2.0));
    const double lost = mean - (sensor.full_well_e - s * (density + d * below));
    const auto codes = codes_of<std::uint16_t>(sensor, flat(400, 300, static_cast<float>(mean)), {5, 0, 0});
    INFO("full well " << below_sd << " standard deviations above the light, which loses " << lost << " electrons");
    CHECK(*std::max_element(codes.begin(), codes.end()) <= 10200);
    // A mean of 120000 pixels is known to s / sqrt(120000) or better: 4.5 of them are 1.3 electrons.
    CHECK(std::abs(sample_of(codes).mean - 200.0 - (mean - lost)) < 4.5 * s / std::sqrt(120000.0));
  }
}

namespace {

constexpr int kWidth = 400;
constexpr int kHeight = 300;
constexpr double kPixels = 120'000.0;
constexpr double kClaim = 4.5;  // standard errors; two-sided 7e-6 a check

double mean_of(const std::vector<float>& values) {
  double sum = 0.0;
  for (const float value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double sd_of(const std::vector<float>& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const float value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

FixedPattern pattern_of(const PixelSpread& spread, double exposure_s = 0.01, std::uint64_t seed = 5) {
  return make_fixed_pattern(spread, exposure_s, seed, kWidth, kHeight);
}

}  // namespace

TEST_CASE("Responses and offsets scatter by PRNU and DSNU about 1 and 0") {
  const FixedPattern pattern = pattern_of({.prnu = 0.02, .dsnu_e = 3.0});
  CHECK(std::abs(mean_of(pattern.response) - 1.0) < kClaim * 0.02 / std::sqrt(kPixels));
  CHECK(std::abs(sd_of(pattern.response) - 0.02) < kClaim * 0.02 / std::sqrt(2.0 * kPixels));
  CHECK(std::abs(mean_of(pattern.offset_e)) < kClaim * 3.0 / std::sqrt(kPixels));
  CHECK(std::abs(sd_of(pattern.offset_e) - 3.0) < kClaim * 3.0 / std::sqrt(2.0 * kPixels));
  CHECK(*std::max_element(pattern.dark_e.begin(), pattern.dark_e.end()) == 0.0f);
}

TEST_CASE("The pattern is white, and response and offset are independent") {
  // The correlation of n independent pairs has a standard deviation of 1/sqrt(n).
  const FixedPattern pattern = pattern_of({.prnu = 0.02, .dsnu_e = 3.0});
  const auto correlation = [](const std::vector<float>& a, const std::vector<float>& b, std::size_t lag) {
    const double mean_a = mean_of(a), mean_b = mean_of(b);
    double sum = 0.0;
    for (std::size_t i = 0; i + lag < a.size(); ++i) sum += (a[i] - mean_a) * (b[i + lag] - mean_b);
    return sum / static_cast<double>(a.size() - lag) / sd_of(a) / sd_of(b);
  };
  const double limit = kClaim / std::sqrt(kPixels);
  for (const std::size_t lag : {1u, 2u, 32u, 400u}) {
    CHECK(std::abs(correlation(pattern.response, pattern.response, lag)) < limit);
    CHECK(std::abs(correlation(pattern.offset_e, pattern.offset_e, lag)) < limit);
  }
  CHECK(std::abs(correlation(pattern.response, pattern.offset_e, 0)) < limit);
  CHECK(std::abs(correlation(pattern.response, pattern_of({.prnu = 0.02}, 0.01, 6).response, 0)) < limit);
}

TEST_CASE("Dark signal grows with the exposure, in hot pixels by an exponential signal more") {
  const PixelSpread spread{.dark_signal_e_s = 40.0, .hot_fraction = 0.01, .hot_signal_e_s = 5000.0};
  const FixedPattern pattern = pattern_of(spread, 0.02);
  std::vector<float> hot_e;
  for (const float dark_e : pattern.dark_e) {
    if (dark_e > 0.8f) hot_e.push_back(dark_e - 0.8f);  // 40 e-/s in 20 ms
  }
  // A binomial number, and a mean of exponential numbers of standard deviation 5000 e-/s * 20 ms each.
  const auto n = static_cast<double>(hot_e.size());
  CHECK(std::abs(n - 1200.0) < kClaim * std::sqrt(1200.0));
  CHECK(std::abs(mean_of(hot_e) - 100.0) < kClaim * 100.0 / std::sqrt(n));
  // Above its mean an exponential number is with probability 1/e.
  const auto above = static_cast<double>(std::count_if(hot_e.begin(), hot_e.end(), [](float e) { return e > 100.0f; }));
  CHECK(std::abs(above - n * std::exp(-1.0)) < kClaim * std::sqrt(n * 0.2325));
  const FixedPattern longer = pattern_of(spread, 0.04);
  for (std::size_t i = 0; i < pattern.dark_e.size(); ++i) {
    REQUIRE(std::abs(longer.dark_e[i] - 2.0f * pattern.dark_e[i]) <= 1e-5f * longer.dark_e[i]);
  }
}

TEST_CASE("Dead pixels answer no light, the others are what they were without them") {
  const FixedPattern whole = pattern_of({.prnu = 0.02});
  const FixedPattern pattern = pattern_of({.prnu = 0.02, .dead_fraction = 0.005});
  double dead = 0.0;
  for (std::size_t i = 0; i < pattern.response.size(); ++i) {
    if (pattern.response[i] == 0.0f) {
      ++dead;
    } else {
      REQUIRE(pattern.response[i] == whole.response[i]);
    }
  }
  CHECK(std::abs(dead - 600.0) < kClaim * std::sqrt(600.0));
}

namespace {

// Double precision: a few roundings of numbers up to 1.
constexpr double kExact = 1e-14;

std::vector<ToneCurve> all_curves() {
  return {{},
          {ToneCurve::Kind::gamma, 2.2, {}, {}},
          {ToneCurve::Kind::bt709, 2.2, {}, {}},
          {ToneCurve::Kind::table, 2.2, {0.0, 0.1, 0.5, 1.0}, {0.0, 0.3, 0.9, 1.0}}};
}

}  // namespace

TEST_CASE("Tone curves take the values of their formulas") {
  const std::vector<ToneCurve> curves = all_curves();
  CHECK(curves[0](0.3) == 0.3);
  CHECK(std::abs(curves[1](0.25) - std::exp(std::log(0.25) / 2.2)) < kExact);
  // BT.709 has 0.0811 at its corner, from both sides within 3e-4 (its constants are rounded).
  CHECK(std::abs(curves[2](0.018 - 1e-12) - 0.081) < 1e-9);
  CHECK(std::abs(curves[2](0.018) - 0.081) < 3e-4);
  CHECK(std::abs(curves[2](0.5) - (1.099 * std::pow(0.5, 0.45) - 0.099)) < kExact);
  CHECK(std::abs(curves[3](0.3) - 0.6) < kExact);  // half way from (0.1, 0.3) to (0.5, 0.9)
}

TEST_CASE("Tone curves rise from 0 to 1, and their inverses undo them") {
  for (const ToneCurve& curve : all_curves()) {
    CAPTURE(name_of(curve.kind));
    CHECK(curve(0.0) == 0.0);
    CHECK(std::abs(curve(1.0) - 1.0) < kExact);
    CHECK(curve(1.7) == curve(1.0));
    double last = -1.0;
    for (int i = 0; i <= 1000; ++i) {
      const double x = i / 1000.0;
      CHECK(curve(x) > last);
      last = curve(x);
      // At BT.709's corner the inverse may take the other branch, 1e-4 off.
      CHECK(std::abs(curve.inverse(curve(x)) - x) < (std::abs(x - 0.018) < 1e-3 ? 1e-4 : 1e-12));
    }
  }
}
