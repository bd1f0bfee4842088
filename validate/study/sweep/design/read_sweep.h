/// The reader of a sweep's file (docs/reference/sweep.md).
#pragma once

#include <filesystem>

#include "base/toml/strict_toml.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// Reads one [[vary]]: its keys, and where their values come from. Errors are recorded in the table's file. Camera
/// files are relative to `folder`.
Axis read_axis(const base::TomlTable& table, Design design, const std::filesystem::path& folder);

/// InputError for any error in the file, its scenario or its cameras: unknown keys of the sweep, an empty range, a
/// value that the scenario refuses (each value of each axis is tried, with the others at their first values), with the
/// line of the key in the sweep's file.
Sweep read_sweep(const std::filesystem::path& path);

}  // namespace glidelab::validate
