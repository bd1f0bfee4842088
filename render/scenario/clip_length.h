/// How long a clip of a scenario may be.
#pragma once

#include <cstddef>

namespace glidelab::render {

/// Frames of one clip: an hour at 1389 Hz. Its true motion is held in memory, 0.6 GB of it.
inline constexpr std::size_t kMostFrames = 5'000'000;

}  // namespace glidelab::render
