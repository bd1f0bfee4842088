/// A scenario: the true motions, and everything that stands before the camera and in it. Read from one TOML file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/scenario.h"

namespace glidelab::render {

struct Scenario {
  std::filesystem::path file;
  std::uint64_t seed = 1;  ///< used where the command line gives none
  sim::MotionScenario motion;
};

/// Reads a whole scenario file (docs/scenario.md). InputError with everything that is wrong with it.
Scenario read_scenario(const std::filesystem::path& path);

}  // namespace glidelab::render
