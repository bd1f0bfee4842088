/// Names of the files that a result is written to. A clip's name is any text; a file's name is not.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result/results.h"

namespace glidelab::report {

/// The text with '/', '%' and control characters written as %XX, so that it names one file of a folder.
std::string file_name_part(std::string_view text);

/// `phase-<clip>.csv` for each clip of the results; where clips of two folders bear one name, the folder's name stands
/// before it (and a number behind it where that is the same as well).
std::vector<std::string> phase_file_names(const core::AnalysisResults& results);

}  // namespace glidelab::report
