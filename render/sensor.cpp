#include "render/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "render/noise_words.h"
#include "render/normal_pair.h"
#include "render/poisson.h"

namespace glidelab::render {
namespace {

/// What a row's pixels are computed with, in single precision.
struct Transfer {
  float read_variance, gain, offset_and_half, largest_code, highest_normal_mean;
};

/// The fast path for a row of groups: codes, and which groups have a pixel that needs the exact path. `own_e` is what
/// each pixel adds after the well; not looked at where kPatterned is false.
template <bool kPatterned, typename Code>
[[gnu::always_inline]] inline void row_codes(int groups, const Transfer& t, const float* __restrict mean,
                                             const float* __restrict own_e, const std::uint32_t* __restrict words,
                                             Code* __restrict codes, bool* __restrict exact) {
  for (int g = 0; g < groups; ++g) {
    alignas(32) float z[kGroup];
    const std::uint32_t* w = words + g * kGroup;
    for (int b = 0; b < kBlocks; ++b) normal_pair(w[b], w[kBlocks + b], z[b], z[kBlocks + b]);
    for (int b = 0; b < kBlocks; ++b) {
      normal_pair(w[2 * kBlocks + b], w[3 * kBlocks + b], z[2 * kBlocks + b], z[3 * kBlocks + b]);
    }
    int beyond = 0;
    for (int i = 0; i < kGroup; ++i) {
      const float expected = mean[g * kGroup + i];
      float electrons = expected + std::sqrt(expected + t.read_variance) * z[i];
      if constexpr (kPatterned) electrons += own_e[g * kGroup + i];
      float code = electrons * t.gain + t.offset_and_half;
      code = code > 0.0f ? code : 0.0f;
      code = code < t.largest_code ? code : t.largest_code;
      codes[g * kGroup + i] = static_cast<Code>(static_cast<std::int32_t>(code));
      beyond |= static_cast<int>(expected < kNormalMean) | static_cast<int>(expected > t.highest_normal_mean);
    }
    exact[g] = beyond != 0;
  }
}

template <bool kPatterned, typename Code>
void row_codes_baseline(int groups, const Transfer& t, const float* mean, const float* own_e,
                        const std::uint32_t* words, Code* codes, bool* exact) {
  row_codes<kPatterned>(groups, t, mean, own_e, words, codes, exact);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
template <bool kPatterned, typename Code>
[[gnu::target("avx2")]] void row_codes_avx2(int groups, const Transfer& t, const float* mean, const float* own_e,
                                            const std::uint32_t* words, Code* codes, bool* exact) {
  row_codes<kPatterned>(groups, t, mean, own_e, words, codes, exact);
}
#endif

const PoissonTable& poisson_table() {
  static const PoissonTable table(static_cast<int>(kNormalMean));
  return table;
}

/// The exact path for one pixel.
int exact_code(const Sensor& sensor, double mean_e, double own_e, std::uint32_t pixel, const NoiseKey& key,
               const PhiloxKey& philox_key) {
  const PhiloxCounter words = philox({pixel, key.frame, key.stream, 1}, philox_key);
  float z_read = 0.0f;
  float z_shot = 0.0f;
  normal_pair(words[2], words[3], z_read, z_shot);
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

/// The expected electrons of a row of pixels, and what its pixels add after the well.
void put_pattern(const FixedPattern& pattern, int y, int left, std::span<float> mean, std::span<float> own_e) {
  const std::size_t first = static_cast<std::size_t>(y) * pattern.width + left;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    mean[i] = mean[i] * pattern.response[first + i] + pattern.dark_e[first + i];
    own_e[i] = pattern.offset_e[first + i];
  }
}

template <typename Code>
void read_out_as(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
                 std::span<Code> codes, Simd simd, const FixedPattern* pattern) {
  if (codes.size() != static_cast<std::size_t>(rect.width) * rect.height ||
      intersection(rect, {0, 0, expected_e.width, expected_e.height}) != rect ||
      sensor.largest_converter_code() > std::numeric_limits<Code>::max() ||
      (pattern != nullptr && (pattern->width != expected_e.width || pattern->height != expected_e.height))) {
    throw std::logic_error(fmt::format("read_out: {} codes for {} x {} pixels of a {} x {} picture, {} bits",
                                       codes.size(), rect.width, rect.height, expected_e.width, expected_e.height,
                                       sensor.converter_bits.value_or(sensor.bit_depth)));
  }
  const RowNoise noise{
      key.frame, key.stream, {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)}};
  const double well = sensor.full_well_e;
  const Transfer transfer{static_cast<float>(sensor.read_noise_e * sensor.read_noise_e),
                          static_cast<float>(sensor.gain_dn_per_e), static_cast<float>(sensor.offset_dn + 0.5),
                          static_cast<float>(sensor.largest_converter_code()),
                          static_cast<float>(well - 6.0 * std::sqrt(well))};
  auto codes_of = pattern != nullptr ? row_codes_baseline<true, Code> : row_codes_baseline<false, Code>;
#if defined(__x86_64__)
  if (uses_avx2(simd)) codes_of = pattern != nullptr ? row_codes_avx2<true, Code> : row_codes_avx2<false, Code>;
#endif
  const int groups_in_row = (expected_e.width + kGroup - 1) / kGroup;
  const int first_group = rect.x / kGroup;
  const int groups = (rect.x + rect.width + kGroup - 1) / kGroup - first_group;
  std::vector<float> mean(static_cast<std::size_t>(groups) * kGroup, kNormalMean);
  const auto own_e = std::make_unique<float[]>(mean.size());
  std::vector<std::uint32_t> words(mean.size());
  std::vector<Code> row(mean.size());
  const auto exact = std::make_unique<bool[]>(static_cast<std::size_t>(groups));
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    const auto first_block = static_cast<std::uint32_t>((y * groups_in_row + first_group) * kBlocks);
    const int left = first_group * kGroup;
    const std::span<const float> source = expected_e.row(y, left, std::min(expected_e.width - left, groups * kGroup));
    std::copy(source.begin(), source.end(), mean.begin());
    if (pattern != nullptr) put_pattern(*pattern, y, left, {mean.data(), source.size()}, {own_e.get(), source.size()});
    row_words(first_block, groups, noise, words.data(), simd);
    codes_of(groups, transfer, mean.data(), own_e.get(), words.data(), row.data(), exact.get());
    for (int g = 0; g < groups; ++g) {
      if (!exact[static_cast<std::size_t>(g)]) continue;
      for (int i = g * kGroup; i < std::min((g + 1) * kGroup, static_cast<int>(source.size())); ++i) {
        const float value = mean[static_cast<std::size_t>(i)];
        if (value >= kNormalMean && value <= transfer.highest_normal_mean) continue;
        row[static_cast<std::size_t>(i)] = static_cast<Code>(
            exact_code(sensor, static_cast<double>(value), static_cast<double>(own_e[static_cast<std::size_t>(i)]),
                       static_cast<std::uint32_t>(y * expected_e.width + left + i), key, noise.key));
      }
    }
    std::copy_n(row.begin() + (rect.x - left), rect.width,
                codes.begin() + static_cast<std::ptrdiff_t>(y - rect.y) * rect.width);
  }
}

}  // namespace

void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint8_t> codes, Simd simd, const FixedPattern* pattern) {
  read_out_as(sensor, expected_e, key, rect, codes, simd, pattern);
}
void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint16_t> codes, Simd simd, const FixedPattern* pattern) {
  read_out_as(sensor, expected_e, key, rect, codes, simd, pattern);
}

}  // namespace glidelab::render
