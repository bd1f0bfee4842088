/// What the person who runs the program permits: an experiment folder may come from a stranger.
#pragma once

#include <cstddef>

namespace glidelab::core {

/// Whether an experiment folder may name files outside itself.
enum class OutsideFiles { refused, allowed };

/// Of an image or a frame of a clip, where nothing else is permitted: more than any camera of today takes at once for
/// film, and 0.6 GB at 16 bits and three channels.
inline constexpr std::size_t kMostPixels = 100'000'000;

struct Permissions {
  OutsideFiles outside = OutsideFiles::refused;
  std::size_t most_pixels = kMostPixels;
};

}  // namespace glidelab::core
