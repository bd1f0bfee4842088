/// How long a clip of a scenario may be.
#pragma once

#include <cstddef>
#include <string>

#include "render/scenario/scenario_data.h"

namespace glidelab::render {

/// Frames of one clip: an hour at 1389 Hz. Its true motion is held in memory, 0.6 GB of it.
inline constexpr std::size_t kMostFrames = 5'000'000;

/// InputError (file, key) if a true motion would have more states than that, with their size as a CSV.
void check_states(const sim::MotionScenario& scenario, const Recording& recording, const std::string& file,
                  const std::string& key);

}  // namespace glidelab::render
