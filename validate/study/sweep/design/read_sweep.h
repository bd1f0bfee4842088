/// Reads a sweep's file (docs/reference/sweep.md).
#pragma once

#include <filesystem>

#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// InputError for what is wrong with the file, its scenario or its cameras: unknown keys of the sweep, an empty range,
/// a value that the scenario refuses (each value of each axis is tried, the others at their first ones), with the line
/// of the sweep's file that the key stands on.
Sweep read_sweep(const std::filesystem::path& path);

}  // namespace glidelab::validate
