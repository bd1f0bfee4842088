/// What the user who runs the program permits: an experiment folder may come from a stranger.
#pragma once

#include <cstddef>

namespace glidelab::core {

/// Whether an experiment folder may name files outside itself.
enum class OutsideFiles { refused, allowed };

/// Largest number of pixels of an image or a frame of a clip, unless more is permitted: more than any present film
/// camera records, and 0.6 GB at 16 bits and three channels.
inline constexpr std::size_t kMostPixels = 100'000'000;

struct Permissions {
  OutsideFiles outside = OutsideFiles::refused;
  std::size_t most_pixels = kMostPixels;
};

}  // namespace glidelab::core
