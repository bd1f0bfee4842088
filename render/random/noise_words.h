/// The random words of a row of pixels: Philox4x32-10, in groups of 32 pixels of 8 blocks each (sensor.h says what
/// for).
#pragma once

#include <cstdint>

#include "base/math/simd.h"
#include "render/random/philox.h"

namespace glidelab::render {

inline constexpr int kBlocks = 8;
inline constexpr int kGroup = 4 * kBlocks;  // pixels

using base::Simd;

struct RowNoise {
  std::uint32_t frame;
  std::uint32_t stream;
  PhiloxKey key;
};

/// Words of the blocks first_block, first_block + 1, …, 8 blocks a group, into `words` (32 a group): word j of block b
/// of group g at 32 g + 8 j + b. RandomPurpose::pixel_noise.
void row_words(std::uint32_t first_block, int groups, const RowNoise& noise, std::uint32_t* words, Simd simd);

}  // namespace glidelab::render
