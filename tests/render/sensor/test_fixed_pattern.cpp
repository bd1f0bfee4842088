#include "render/sensor/sensor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/catch.h"

using namespace glidelab::render;

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
