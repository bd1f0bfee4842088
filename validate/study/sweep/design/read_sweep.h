/// The reader of a sweep's file (docs/reference/sweep.md).
#pragma once

#include <filesystem>

#include "base/toml/strict_toml.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// Reads one [[vary]]: its keys, and where their values come from. What is wrong is recorded in the table's file.
/// Cameras are sought from `folder`.
Axis read_axis(const base::TomlTable& table, Design design, const std::filesystem::path& folder);

/// InputError for what is wrong with the file, its scenario or its cameras: unknown keys of the sweep, an empty range,
/// a value that the scenario refuses (each value of each axis is tried, the others at their first ones), with the line
/// of the sweep's file that the key stands on.
Sweep read_sweep(const std::filesystem::path& path);

}  // namespace glidelab::validate
