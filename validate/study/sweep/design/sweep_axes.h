/// Reads one [[vary]] of a sweep's file: its keys, and where their values come from (docs/reference/sweep.md).
#pragma once

#include <filesystem>

#include "base/toml/strict_toml.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// What is wrong is recorded in the table's file. Cameras are sought from `folder`.
Axis read_axis(const base::TomlTable& table, Design design, const std::filesystem::path& folder);

}  // namespace glidelab::validate
