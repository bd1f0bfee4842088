#include "render/sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "render/philox.h"
#include "render/poisson.h"

namespace glidelab::render {
namespace {

constexpr int kBlocks = 8;
constexpr int kGroup = 4 * kBlocks;  // pixels

/// 2 pi of an angle given in turns, as sine: |x| <= 1/4; minimax of degree 7, error 6e-7.
inline float sine_of_turns(float x) {
  const float q = x * x;
  return x * (6.28316404f + q * (-41.3371423f + q * (81.3407651f + q * -70.9933988f)));
}

/// Natural logarithm of 0 < x < 2; minimax of degree 6 in the mantissa from sqrt(1/2) to sqrt(2), error 1.5e-6.
inline float log_of(float x) {
  constexpr std::int32_t kRootHalf = 0x3F3504F3;  // the bits of sqrt(1/2)
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kRootHalf) >> 23;
  const float m = std::bit_cast<float>(bits - (exponent << 23)) - 1.0f;
  const float polynomial =
      1.00001278f +
      m * (-0.499850506f + m * (0.332258767f + m * (-0.25472486f + m * (0.223300294f + m * -0.14319701f))));
  return static_cast<float>(exponent) * 0.693147181f + m * polynomial;
}

/// Two normal deviates of two words (Box and Muller).
inline void normal_pair(std::uint32_t word0, std::uint32_t word1, float& z0, float& z1) {
  constexpr float kBit = 1.0f / 16777216.0f;  // 2^-24
  const float u = (static_cast<float>(static_cast<std::int32_t>(word0 >> 8)) + 0.5f) * kBit;
  const float turns = static_cast<float>(static_cast<std::int32_t>(word1) >> 8) * kBit;  // [-1/2, 1/2)
  const float under_root = -2.0f * log_of(u);
  const float radius = std::sqrt(under_root > 0.0f ? under_root : 0.0f);
  const float away = turns < 0.0f ? -turns : turns;
  const float beyond = away - 0.25f;
  const float folded = 0.25f - (beyond < 0.0f ? -beyond : beyond);
  const float sine = sine_of_turns(folded);
  z0 = radius * sine_of_turns(0.25f - away);
  z1 = radius * (turns < 0.0f ? -sine : sine);
}

struct RowNoise {
  std::uint32_t frame;
  std::uint32_t stream;
  PhiloxKey key;
};

/// Words of the blocks first_block, first_block + 1, …, 8 blocks a group: word j of block b of group g at 32 g + 8 j +
/// b.
void row_words_portable(std::uint32_t first_block, int groups, const RowNoise& noise, std::uint32_t* words) {
  for (int block = 0; block < groups * kBlocks; ++block) {
    const PhiloxCounter four =
        philox({first_block + static_cast<std::uint32_t>(block), noise.frame, noise.stream, 0}, noise.key);
    for (int j = 0; j < 4; ++j) words[block / kBlocks * kGroup + j * kBlocks + block % kBlocks] = four[j];
  }
}

#if defined(__x86_64__)
// Philox on four blocks at a time, each in the lower half of a 64-bit lane (what stands in the upper half is ignored by
// the multiplication): blocks 0, 2, 4, 6 in one vector, 1, 3, 5, 7 in the other, merged at the end.
[[gnu::target("avx2")]] void row_words_avx2(std::uint32_t first_block, int groups, const RowNoise& noise,
                                            std::uint32_t* words) {
  const __m256i m0 = _mm256_set1_epi64x(kPhiloxM0);
  const __m256i m1 = _mm256_set1_epi64x(kPhiloxM1);
  const __m256i low_half = _mm256_set1_epi64x(0xFFFFFFFF);
  for (int g = 0; g < groups; ++g) {
    const __m256i block =
        _mm256_set1_epi32(static_cast<std::int32_t>(first_block + static_cast<std::uint32_t>(g * kBlocks)));
    __m256i c[2][4];
    for (int h = 0; h < 2; ++h) {
      c[h][0] = _mm256_add_epi32(block, _mm256_setr_epi32(h, 0, 2 + h, 0, 4 + h, 0, 6 + h, 0));
      c[h][1] = _mm256_set1_epi64x(noise.frame);
      c[h][2] = _mm256_set1_epi64x(noise.stream);
      c[h][3] = _mm256_setzero_si256();
    }
    PhiloxKey key = noise.key;
    for (int round = 0; round < kPhiloxRounds; ++round) {
      const __m256i k0 = _mm256_set1_epi32(static_cast<std::int32_t>(key[0]));
      const __m256i k1 = _mm256_set1_epi32(static_cast<std::int32_t>(key[1]));
      for (auto& half : c) {
        const __m256i product0 = _mm256_mul_epu32(half[0], m0);
        const __m256i product1 = _mm256_mul_epu32(half[2], m1);
        half[0] = _mm256_xor_si256(_mm256_srli_epi64(product1, 32), _mm256_xor_si256(half[1], k0));
        half[1] = product1;
        half[2] = _mm256_xor_si256(_mm256_srli_epi64(product0, 32), _mm256_xor_si256(half[3], k1));
        half[3] = product0;
      }
      key[0] += kPhiloxW0;
      key[1] += kPhiloxW1;
    }
    for (int j = 0; j < 4; ++j) {
      const __m256i merged = _mm256_or_si256(_mm256_and_si256(c[0][j], low_half), _mm256_slli_epi64(c[1][j], 32));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(words + g * kGroup + j * kBlocks), merged);
    }
  }
}

// The same with SSE2, which every x86-64 has: two blocks a vector.
void row_words_sse2(std::uint32_t first_block, int groups, const RowNoise& noise, std::uint32_t* words) {
  const __m128i m0 = _mm_set1_epi64x(kPhiloxM0);
  const __m128i m1 = _mm_set1_epi64x(kPhiloxM1);
  const __m128i low_half = _mm_set1_epi64x(0xFFFFFFFF);
  for (int g = 0; g < 2 * groups; ++g) {  // half a group at a time
    const __m128i block =
        _mm_set1_epi32(static_cast<std::int32_t>(first_block + static_cast<std::uint32_t>(g * kBlocks / 2)));
    __m128i c[2][4];
    for (int h = 0; h < 2; ++h) {
      c[h][0] = _mm_add_epi32(block, _mm_setr_epi32(h, 0, 2 + h, 0));
      c[h][1] = _mm_set1_epi64x(noise.frame);
      c[h][2] = _mm_set1_epi64x(noise.stream);
      c[h][3] = _mm_setzero_si128();
    }
    PhiloxKey key = noise.key;
    for (int round = 0; round < kPhiloxRounds; ++round) {
      const __m128i k0 = _mm_set1_epi32(static_cast<std::int32_t>(key[0]));
      const __m128i k1 = _mm_set1_epi32(static_cast<std::int32_t>(key[1]));
      for (auto& half : c) {
        const __m128i product0 = _mm_mul_epu32(half[0], m0);
        const __m128i product1 = _mm_mul_epu32(half[2], m1);
        half[0] = _mm_xor_si128(_mm_srli_epi64(product1, 32), _mm_xor_si128(half[1], k0));
        half[1] = product1;
        half[2] = _mm_xor_si128(_mm_srli_epi64(product0, 32), _mm_xor_si128(half[3], k1));
        half[3] = product0;
      }
      key[0] += kPhiloxW0;
      key[1] += kPhiloxW1;
    }
    for (int j = 0; j < 4; ++j) {
      const __m128i merged = _mm_or_si128(_mm_and_si128(c[0][j], low_half), _mm_slli_epi64(c[1][j], 32));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(words + g / 2 * kGroup + j * kBlocks + g % 2 * 4), merged);
    }
  }
}
#endif

/// What a row's pixels are computed with, in single precision.
struct Transfer {
  float read_variance, gain, offset_and_half, largest_code, highest_normal_mean;
};

/// The fast path for a row of groups: codes, and which groups have a pixel that needs the exact path.
template <typename Code>
[[gnu::always_inline]] inline void row_codes(int groups, const Transfer& t, const float* __restrict mean,
                                             const std::uint32_t* __restrict words, Code* __restrict codes,
                                             bool* __restrict exact) {
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
      const float electrons = expected + std::sqrt(expected + t.read_variance) * z[i];
      float code = electrons * t.gain + t.offset_and_half;
      code = code > 0.0f ? code : 0.0f;
      code = code < t.largest_code ? code : t.largest_code;
      codes[g * kGroup + i] = static_cast<Code>(static_cast<std::int32_t>(code));
      beyond |= static_cast<int>(expected < kNormalMean) | static_cast<int>(expected > t.highest_normal_mean);
    }
    exact[g] = beyond != 0;
  }
}

template <typename Code>
void row_codes_baseline(int groups, const Transfer& t, const float* mean, const std::uint32_t* words, Code* codes,
                        bool* exact) {
  row_codes(groups, t, mean, words, codes, exact);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
template <typename Code>
[[gnu::target("avx2")]] void row_codes_avx2(int groups, const Transfer& t, const float* mean,
                                            const std::uint32_t* words, Code* codes, bool* exact) {
  row_codes(groups, t, mean, words, codes, exact);
}
#endif

const PoissonTable& poisson_table() {
  static const PoissonTable table(static_cast<int>(kNormalMean));
  return table;
}

/// The exact path for one pixel.
int exact_code(const Sensor& sensor, double mean_e, std::uint32_t pixel, const NoiseKey& key,
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
  const double code = std::floor(electrons * sensor.gain_dn_per_e + sensor.offset_dn + 0.5);
  return static_cast<int>(std::clamp(code, 0.0, static_cast<double>(sensor.largest_code())));
}

template <typename Code>
void read_out_as(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
                 std::span<Code> codes, Simd simd) {
  if (codes.size() != static_cast<std::size_t>(rect.width) * rect.height ||
      intersection(rect, {0, 0, expected_e.width, expected_e.height}) != rect ||
      sensor.largest_code() > std::numeric_limits<Code>::max()) {
    throw std::logic_error(fmt::format("read_out: {} codes for {} x {} pixels of a {} x {} picture, {} bits",
                                       codes.size(), rect.width, rect.height, expected_e.width, expected_e.height,
                                       sensor.bit_depth));
  }
  const RowNoise noise{
      key.frame, key.stream, {static_cast<std::uint32_t>(key.seed), static_cast<std::uint32_t>(key.seed >> 32)}};
  const double well = sensor.full_well_e;
  const Transfer transfer{static_cast<float>(sensor.read_noise_e * sensor.read_noise_e),
                          static_cast<float>(sensor.gain_dn_per_e), static_cast<float>(sensor.offset_dn + 0.5),
                          static_cast<float>(sensor.largest_code()), static_cast<float>(well - 6.0 * std::sqrt(well))};
  auto codes_of = row_codes_baseline<Code>;
  auto words_of = row_words_portable;
#if defined(__x86_64__)
  const bool avx2 = simd != Simd::baseline && __builtin_cpu_supports("avx2");
  if (avx2) codes_of = row_codes_avx2<Code>;
  if (simd != Simd::portable) words_of = avx2 ? row_words_avx2 : row_words_sse2;
#endif
  const int groups_in_row = (expected_e.width + kGroup - 1) / kGroup;
  const int first_group = rect.x / kGroup;
  const int groups = (rect.x + rect.width + kGroup - 1) / kGroup - first_group;
  std::vector<float> mean(static_cast<std::size_t>(groups) * kGroup, kNormalMean);
  std::vector<std::uint32_t> words(mean.size());
  std::vector<Code> row(mean.size());
  const auto exact = std::make_unique<bool[]>(static_cast<std::size_t>(groups));
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    const auto first_block = static_cast<std::uint32_t>((y * groups_in_row + first_group) * kBlocks);
    const int left = first_group * kGroup;
    const std::span<const float> source = expected_e.row(y, left, std::min(expected_e.width - left, groups * kGroup));
    std::copy(source.begin(), source.end(), mean.begin());
    words_of(first_block, groups, noise, words.data());
    codes_of(groups, transfer, mean.data(), words.data(), row.data(), exact.get());
    for (int g = 0; g < groups; ++g) {
      if (!exact[static_cast<std::size_t>(g)]) continue;
      for (int i = g * kGroup; i < std::min((g + 1) * kGroup, static_cast<int>(source.size())); ++i) {
        const float value = mean[static_cast<std::size_t>(i)];
        if (value >= kNormalMean && value <= transfer.highest_normal_mean) continue;
        row[static_cast<std::size_t>(i)] =
            static_cast<Code>(exact_code(sensor, static_cast<double>(value),
                                         static_cast<std::uint32_t>(y * expected_e.width + left + i), key, noise.key));
      }
    }
    std::copy_n(row.begin() + (rect.x - left), rect.width,
                codes.begin() + static_cast<std::ptrdiff_t>(y - rect.y) * rect.width);
  }
}

}  // namespace

void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint8_t> codes, Simd simd) {
  read_out_as(sensor, expected_e, key, rect, codes, simd);
}
void read_out(const Sensor& sensor, const FloatPicture& expected_e, const NoiseKey& key, const PixelRect& rect,
              std::span<std::uint16_t> codes, Simd simd) {
  read_out_as(sensor, expected_e, key, rect, codes, simd);
}

}  // namespace glidelab::render
