/// The random words of a row of pixels: Philox4x32-10, in groups of 32 pixels of 8 blocks each (sensor.h says what
/// for).
#pragma once

#include <cstdint>

#include "render/philox.h"

namespace glidelab::render {

inline constexpr int kBlocks = 8;
inline constexpr int kGroup = 4 * kBlocks;  // pixels

/// Which instructions; all give the same words and codes (a test compares them).
enum class Simd { best, baseline, portable };

/// Whether `simd` means AVX2 on this machine.
bool uses_avx2(Simd simd);

struct RowNoise {
  std::uint32_t frame;
  std::uint32_t stream;
  PhiloxKey key;
};

/// Words of the blocks first_block, first_block + 1, …, 8 blocks a group, into `words` (32 a group): word j of block b
/// of group g at 32 g + 8 j + b. The counter is {block, frame, stream, 0}.
void row_words(std::uint32_t first_block, int groups, const RowNoise& noise, std::uint32_t* words, Simd simd);

}  // namespace glidelab::render
