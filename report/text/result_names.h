/// What a result's configurations are called, and the files it is written to. A clip's name is any text; a file's name
/// is not.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result/results.h"

namespace glidelab::report {

/// "0.335 kg, 4°", and with the group where another of the results has the same mass and stated inclination: "0.5 kg,
/// 2°, plunger". Text from a file: to be escaped.
std::string configuration_name(const core::AnalysisResults& results, const core::ConfigurationResult& configuration);

/// The text with '/', '%' and control characters written as %XX, so that it names one file of a folder.
std::string file_name_part(std::string_view text);

/// `phase-<clip>.csv` for each clip of the results; where clips of two folders bear one name, the folder's name stands
/// before it (and a number behind it where that is the same as well).
std::vector<std::string> phase_file_names(const core::AnalysisResults& results);

}  // namespace glidelab::report
