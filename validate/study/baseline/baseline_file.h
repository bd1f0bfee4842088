/// A baseline as a JSON file.
#pragma once

#include <filesystem>
#include <string>

#include "validate/study/baseline/baseline.h"

namespace glidelab::validate {

std::string baseline_json(const Baseline& baseline);
/// InputError for a file that --write-baseline did not write, with the first key that is wrong.
Baseline read_baseline(const std::filesystem::path& file);

}  // namespace glidelab::validate
