#include "render/random/random_numbers.h"

#include <cmath>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace glidelab::render {
namespace {

void row_words_portable(std::uint32_t first_block, int groups, const RowNoise& noise, std::uint32_t* words) {
  for (int block = 0; block < groups * kBlocks; ++block) {
    const PhiloxCounter four =
        random_words(RandomPurpose::pixel_noise,
                     {first_block + static_cast<std::uint32_t>(block), noise.frame, noise.stream}, noise.key);
    for (int j = 0; j < 4; ++j) words[block / kBlocks * kGroup + j * kBlocks + block % kBlocks] = four[j];
  }
}

#if defined(__x86_64__)
// Philox on four blocks at a time, each in the lower half of a 64-bit lane (the multiplication ignores the upper half):
// blocks 0, 2, 4, 6 in one vector, 1, 3, 5, 7 in the other, merged at the end.
[[gnu::target("avx2")]] void row_words_avx2(std::uint32_t first_block, int groups, const RowNoise& noise,
                                            std::uint32_t* words) {
  const __m256i m0 = _mm256_set1_epi64x(kPhiloxM0);
  const __m256i m1 = _mm256_set1_epi64x(kPhiloxM1);
  alignas(32) __m256i keys[kPhiloxRounds][2];  // for each round, made once and not for every group
  PhiloxKey key = noise.key;
  for (auto& pair : keys) {
    for (int k = 0; k < 2; ++k) pair[k] = _mm256_set1_epi32(static_cast<std::int32_t>(key[k]));
    key[0] += kPhiloxW0;
    key[1] += kPhiloxW1;
  }
  for (int g = 0; g < groups; ++g) {
    const __m256i block =
        _mm256_set1_epi32(static_cast<std::int32_t>(first_block + static_cast<std::uint32_t>(g * kBlocks)));
    __m256i c[2][4];
    for (int h = 0; h < 2; ++h) {
      c[h][0] = _mm256_add_epi32(block, _mm256_setr_epi32(h, 0, 2 + h, 0, 4 + h, 0, 6 + h, 0));
      c[h][1] = _mm256_set1_epi64x(noise.frame);
      c[h][2] = _mm256_set1_epi64x(noise.stream);
      c[h][3] = _mm256_set1_epi64x(static_cast<std::uint32_t>(RandomPurpose::pixel_noise));
    }
    for (const auto& [k0, k1] : keys) {
      for (auto& half : c) {
        const __m256i product0 = _mm256_mul_epu32(half[0], m0);
        const __m256i product1 = _mm256_mul_epu32(half[2], m1);
        half[0] = _mm256_xor_si256(_mm256_srli_epi64(product1, 32), _mm256_xor_si256(half[1], k0));
        half[1] = product1;
        half[2] = _mm256_xor_si256(_mm256_srli_epi64(product0, 32), _mm256_xor_si256(half[3], k1));
        half[3] = product0;
      }
    }
    for (int j = 0; j < 4; ++j) {
      const __m256i merged = _mm256_blend_epi32(c[0][j], _mm256_slli_epi64(c[1][j], 32), 0b10101010);
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(words + g * kGroup + j * kBlocks), merged);
    }
  }
}

// The same with SSE2, which every x86-64 has: two blocks per vector.
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
      c[h][3] = _mm_set1_epi64x(static_cast<std::uint32_t>(RandomPurpose::pixel_noise));
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

}  // namespace

void row_words(std::uint32_t first_block, int groups, const RowNoise& noise, std::uint32_t* words,
               [[maybe_unused]] Simd simd) {
#if defined(__x86_64__)
  if (simd != Simd::portable) {
    base::uses_avx2(simd) ? row_words_avx2(first_block, groups, noise, words)
                          : row_words_sse2(first_block, groups, noise, words);
    return;
  }
#endif
  row_words_portable(first_block, groups, noise, words);
}

PoissonTable::PoissonTable(int largest_mean) {
  for (int mean = 0; mean < largest_mean; ++mean) {
    Distribution distribution;
    double sum = 0.0;
    for (int k = 0;; ++k) {
      sum += mean == 0 ? (k == 0 ? 1.0 : 0.0) : std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0));
      distribution.below.push_back(sum);
      // The remainder is below a quarter of a word's resolution; the last entry takes it.
      if (k > mean && sum > 1.0 - 0.5 * uniform_of(0)) break;
      if (k > mean + 20.0 * std::sqrt(mean + 1.0) + 20.0) break;
    }
    distribution.below.back() = 1.0;
    std::uint16_t k = 0;
    for (int i = 0; i < 256; ++i) {
      while (distribution.below[k] < i / 256.0) ++k;
      distribution.guide.push_back(k);
    }
    whole_.push_back(std::move(distribution));
  }
}

int PoissonTable::draw(double mean, std::uint32_t whole_word, std::uint32_t rest_word) const {
  const int whole = static_cast<int>(mean);
  const Distribution& distribution = whole_.at(static_cast<std::size_t>(whole));
  const double u = uniform_of(whole_word);
  int count = distribution.guide[whole_word >> 24];
  while (distribution.below[static_cast<std::size_t>(count)] < u) ++count;
  const double rest = mean - whole;
  double term = std::exp(-rest);
  double v = uniform_of(rest_word) - term;
  for (int k = 1; v > 0.0 && k < 40; ++k) {  // beyond 40 the probability is below 1e-47
    term *= rest / k;
    v -= term;
    ++count;
  }
  return count;
}

}  // namespace glidelab::render
