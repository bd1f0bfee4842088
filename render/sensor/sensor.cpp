#include "render/sensor/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "render/random/random_numbers.h"

namespace glidelab::render {
namespace {

// ITU-R BT.709-6, item 1.2.
constexpr double kToe = 0.018;
constexpr double kToeSlope = 4.5;
constexpr double kScale = 1.099;
constexpr double kPower = 0.45;

/// Straight lines through points whose x rise.
double between_points(std::span<const double> from, std::span<const double> to, double x) {
  const auto after = std::upper_bound(from.begin() + 1, from.end() - 1, x) - from.begin();
  const auto i = static_cast<std::size_t>(after);
  return to[i - 1] + (x - from[i - 1]) / (from[i] - from[i - 1]) * (to[i] - to[i - 1]);
}

}  // namespace

double ToneCurve::operator()(double x) const {
  x = std::clamp(x, 0.0, 1.0);
  switch (kind) {
    case Kind::linear:
      return x;
    case Kind::gamma:
      return std::pow(x, 1.0 / gamma);
    case Kind::bt709:
      return x < kToe ? kToeSlope * x : kScale * std::pow(x, kPower) - (kScale - 1.0);
    case Kind::table:
      return between_points(from, to, x);
  }
  throw std::logic_error("unknown tone curve");
}

double ToneCurve::inverse(double y) const {
  y = std::clamp(y, 0.0, 1.0);
  switch (kind) {
    case Kind::linear:
      return y;
    case Kind::gamma:
      return std::pow(y, gamma);
    case Kind::bt709:
      return y < kToeSlope * kToe ? y / kToeSlope : std::pow((y + (kScale - 1.0)) / kScale, 1.0 / kPower);
    case Kind::table:
      return between_points(to, from, y);
  }
  throw std::logic_error("unknown tone curve");
}

const char* name_of(ToneCurve::Kind kind) {
  switch (kind) {
    case ToneCurve::Kind::linear:
      return "linear";
    case ToneCurve::Kind::gamma:
      return "gamma";
    case ToneCurve::Kind::bt709:
      return "bt709";
    case ToneCurve::Kind::table:
      return "table";
  }
  throw std::logic_error("unknown tone curve");
}

FixedPattern make_fixed_pattern(const PixelSpread& spread, double exposure_s, std::uint64_t seed, int width,
                                int height) {
  const PhiloxKey key = philox_key(seed);
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  const auto dark_e = static_cast<float>(spread.dark_signal_e_s * exposure_s);
  FixedPattern pattern{width, height, std::vector<float>(pixels), std::vector<float>(pixels, dark_e),
                       std::vector<float>(pixels)};
  for (std::size_t i = 0; i < pixels; ++i) {
    const PhiloxCounter words = random_words(RandomPurpose::fixed_pattern, {static_cast<std::uint32_t>(i), 0, 0}, key);
    const auto [z1, z2] = normal_pair(words[0], words[1]);
    pattern.response[i] = std::max(0.0f, 1.0f + static_cast<float>(spread.prnu) * z1);
    pattern.offset_e[i] = static_cast<float>(spread.dsnu_e) * z2;
    const double hot = uniform_of(words[2]);
    if (hot < spread.hot_fraction) {
      // Below the fraction the word is again uniform, so minus its logarithm is exponential with mean 1.
      const double signal_e_s = -std::log(hot / spread.hot_fraction) * spread.hot_signal_e_s;
      pattern.dark_e[i] += static_cast<float>(signal_e_s * exposure_s);
    }
    if (uniform_of(words[3]) < spread.dead_fraction) pattern.response[i] = 0.0f;
  }
  return pattern;
}

namespace {

/// The constants for computing a row's pixels, in single precision.
struct Transfer {
  float read_variance, gain, offset_and_half, largest_code, highest_normal_mean;
};

/// Successive pixels: their expected light, and how each differs (null if all are alike).
struct Pixels {
  const float* expected_e;
  const float* response;
  const float* dark_e;
  const float* offset_e;
};

constexpr int kBatch = 16;  // groups

/// The fast path for groups of pixels; returns whether some of them need the exact path. The pattern is not used if
/// kPatterned is false. A processor can overlap several iterations of each of its two short loops.
template <bool kPatterned, typename Code>
[[gnu::always_inline]] inline bool group_codes(int groups, const Transfer& t, const Pixels& pixels,
                                               const std::uint32_t* __restrict words, Code* __restrict codes) {
  int beyond = 0;
  alignas(32) float square[kBatch * kGroup], turn[kBatch * kGroup];
  for (int first = 0; first < groups; first += kBatch) {
    const int start = first * kGroup;
    const int count = std::min(groups - first, kBatch) * kGroup;
    for (int at = 0; at < count; at += 2 * kBlocks) {
      for (int i = at; i < at + kBlocks; ++i) {
        const PolarPair polar = polar_pair(words[start + i], words[start + i + kBlocks]);
        square[i] = square[i + kBlocks] = polar.square;
        turn[i] = polar.cosine;
        turn[i + kBlocks] = polar.sine;
      }
    }
    for (int i = 0; i < count; ++i) {
      const int p = start + i;
      float expected = pixels.expected_e[p];
      if constexpr (kPatterned) expected = expected * pixels.response[p] + pixels.dark_e[p];
      float electrons = expected + std::sqrt(square[i] * (expected + t.read_variance)) * turn[i];
      if constexpr (kPatterned) electrons += pixels.offset_e[p];
      float code = electrons * t.gain + t.offset_and_half;
      code = code > 0.0f ? code : 0.0f;
      code = code < t.largest_code ? code : t.largest_code;
      codes[p] = static_cast<Code>(static_cast<std::int32_t>(code));
      beyond |= static_cast<int>(expected < kNormalMean) | static_cast<int>(expected > t.highest_normal_mean);
    }
  }
  return beyond != 0;
}

template <bool kPatterned, typename Code>
bool group_codes_baseline(int groups, const Transfer& t, const Pixels& pixels, const std::uint32_t* words,
                          Code* codes) {
  return group_codes<kPatterned>(groups, t, pixels, words, codes);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
template <bool kPatterned, typename Code>
[[gnu::target("avx2")]] bool group_codes_avx2(int groups, const Transfer& t, const Pixels& pixels,
                                              const std::uint32_t* words, Code* codes) {
  return group_codes<kPatterned>(groups, t, pixels, words, codes);
}
#endif

const PoissonTable& poisson_table() {
  static const PoissonTable table(static_cast<int>(kNormalMean));
  return table;
}

/// The exact path for one pixel.
int exact_code(const Sensor& sensor, double mean_e, double own_e, std::uint32_t pixel, const NoiseKey& key,
               const PhiloxKey& words_key) {
  const PhiloxCounter words = random_words(RandomPurpose::exact_pixel_noise, {pixel, key.frame, key.stream}, words_key);
  const auto [z_read, z_shot] = normal_pair(words[2], words[3]);
  double electrons = 0.0;
  if (mean_e < static_cast<double>(kNormalMean)) {
    electrons = poisson_table().draw(mean_e, words[0], words[1]);
  } else {
    electrons = mean_e + std::sqrt(mean_e) * static_cast<double>(z_shot);
  }
  electrons = std::min(electrons, sensor.full_well_e) + sensor.read_noise_e * static_cast<double>(z_read);
  electrons += own_e;
  const double code = std::floor(electrons * sensor.gain_dn_per_e + sensor.offset_dn + 0.5);
  return static_cast<int>(std::clamp(code, 0.0, static_cast<double>(sensor.largest_converter_code())));
}

/// A copy of pixels that do not fill a group, padded with pixels that do not need the exact path.
class FilledGroup {
 public:
  FilledGroup(const Pixels& pixels, int count) {
    const auto filled = [&](const float* from, float filling, int place) -> const float* {
      if (from == nullptr) return nullptr;
      float* const to = values_.data() + place * kGroup;
      std::fill(std::copy_n(from, count, to), to + kGroup, filling);
      return to;
    };
    pixels_ = {filled(pixels.expected_e, kNormalMean, 0), filled(pixels.response, 1.0f, 1),
               filled(pixels.dark_e, 0.0f, 2), filled(pixels.offset_e, 0.0f, 3)};
  }
  FilledGroup(const FilledGroup&) = delete;
  FilledGroup& operator=(const FilledGroup&) = delete;
  const Pixels& pixels() const { return pixels_; }

 private:
  std::array<float, std::size_t{4} * kGroup> values_;
  Pixels pixels_;
};

/// Rows of one image.
template <typename Code>
class RowReader {
 public:
  RowReader(const Sensor& sensor, const FloatImage& expected_e, const NoiseKey& key, Simd simd,
            const FixedPattern* pattern)
      : sensor_(sensor),
        expected_e_(expected_e),
        key_(key),
        simd_(simd),
        pattern_(pattern),
        noise_{key.frame, key.stream, philox_key(key.seed)},
        groups_in_row_((expected_e.width + kGroup - 1) / kGroup),
        words_(static_cast<std::size_t>(groups_in_row_) * kGroup) {
    const double well = sensor.full_well_e;
    transfer_ = {static_cast<float>(sensor.read_noise_e * sensor.read_noise_e),
                 static_cast<float>(sensor.gain_dn_per_e), static_cast<float>(sensor.offset_dn + 0.5),
                 static_cast<float>(sensor.largest_converter_code()), static_cast<float>(well - 6.0 * std::sqrt(well))};
    codes_of_ = pattern != nullptr ? group_codes_baseline<true, Code> : group_codes_baseline<false, Code>;
#if defined(__x86_64__)
    if (base::uses_avx2(simd))
      codes_of_ = pattern != nullptr ? group_codes_avx2<true, Code> : group_codes_avx2<false, Code>;
#endif
  }

  /// Codes of the pixels [left, right) of row y: whole groups in place, a partial group through a copy.
  void read(int y, int left, int right, Code* codes) {
    const int first_whole = (left + kGroup - 1) / kGroup;
    const int end_whole = right / kGroup;
    if (first_whole > end_whole) {  // within one group
      read_part(y, end_whole, left, right, codes);
      return;
    }
    if (left < first_whole * kGroup) read_part(y, first_whole - 1, left, first_whole * kGroup, codes);
    if (first_whole < end_whole) {
      read_groups(y, first_whole, end_whole - first_whole, pixels_at(y, first_whole * kGroup), kGroup,
                  codes + (first_whole * kGroup - left));
    }
    if (end_whole * kGroup < right) {
      read_part(y, end_whole, end_whole * kGroup, right, codes + (end_whole * kGroup - left));
    }
  }

 private:
  Pixels pixels_at(int y, int x) const {
    const auto at = static_cast<std::size_t>(y) * expected_e_.width + x;
    if (pattern_ == nullptr) return {expected_e_.values.data() + at, nullptr, nullptr, nullptr};
    return {expected_e_.values.data() + at, pattern_->response.data() + at, pattern_->dark_e.data() + at,
            pattern_->offset_e.data() + at};
  }

  /// The pixels [left, right), all in one group.
  void read_part(int y, int group, int left, int right, Code* codes) {
    const int start = group * kGroup;
    const int there = std::min(expected_e_.width - start, kGroup);
    const FilledGroup filled(pixels_at(y, start), there);
    std::array<Code, kGroup> all;
    read_groups(y, group, 1, filled.pixels(), there, all.data());
    std::copy(all.begin() + (left - start), all.begin() + (right - start), codes);
  }

  /// `last` pixels of the last group are in the image.
  void read_groups(int y, int first, int groups, const Pixels& pixels, int last, Code* codes) {
    const auto block = static_cast<std::uint32_t>((y * groups_in_row_ + first) * kBlocks);
    row_words(block, groups, noise_, words_.data(), simd_);
    if (!codes_of_(groups, transfer_, pixels, words_.data(), codes)) return;
    const int count = (groups - 1) * kGroup + last;
    for (int i = 0; i < count; ++i) {
      const float light = pixels.expected_e[i];
      const float expected = pattern_ == nullptr ? light : light * pixels.response[i] + pixels.dark_e[i];
      if (expected >= kNormalMean && expected <= transfer_.highest_normal_mean) continue;
      const auto number = static_cast<std::uint32_t>(y * expected_e_.width + first * kGroup + i);
      const double own_e = pattern_ == nullptr ? 0.0 : static_cast<double>(pixels.offset_e[i]);
      codes[i] = static_cast<Code>(exact_code(sensor_, static_cast<double>(expected), own_e, number, key_, noise_.key));
    }
  }

  const Sensor& sensor_;
  const FloatImage& expected_e_;
  const NoiseKey& key_;
  Simd simd_;
  const FixedPattern* pattern_;
  RowNoise noise_;
  int groups_in_row_;
  Transfer transfer_;
  bool (*codes_of_)(int, const Transfer&, const Pixels&, const std::uint32_t*, Code*);
  std::vector<std::uint32_t> words_;
};

template <typename Code>
void read_out_as(const Sensor& sensor, const FloatImage& expected_e, const NoiseKey& key, const PixelRect& rect,
                 std::span<Code> codes, Simd simd, const FixedPattern* pattern) {
  if (codes.size() != static_cast<std::size_t>(rect.width) * rect.height ||
      intersection(rect, {0, 0, expected_e.width, expected_e.height}) != rect ||
      sensor.largest_converter_code() > std::numeric_limits<Code>::max() ||
      (pattern != nullptr && (pattern->width != expected_e.width || pattern->height != expected_e.height))) {
    throw std::logic_error(fmt::format("read_out: {} codes for {} x {} pixels of a {} x {} image, {} bits",
                                       codes.size(), rect.width, rect.height, expected_e.width, expected_e.height,
                                       sensor.converter_bits.value_or(sensor.bit_depth)));
  }
  RowReader<Code> reader(sensor, expected_e, key, simd, pattern);
  for (int y = 0; y < rect.height; ++y) {
    reader.read(rect.y + y, rect.x, rect.x + rect.width, codes.data() + static_cast<std::ptrdiff_t>(y) * rect.width);
  }
}

}  // namespace

void read_out(const Sensor& sensor, const FloatImage& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint8_t> codes, Simd simd, const FixedPattern* pattern) {
  read_out_as(sensor, expected_e, key, rect, codes, simd, pattern);
}
void read_out(const Sensor& sensor, const FloatImage& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint16_t> codes, Simd simd, const FixedPattern* pattern) {
  read_out_as(sensor, expected_e, key, rect, codes, simd, pattern);
}

}  // namespace glidelab::render
