/// What a configuration is called where it is spoken of.
#pragma once

#include <string>

#include "core/result/results.h"

namespace glidelab::report {

/// "0.335 kg, 4°", and with the group where another of the results has the same mass and stated inclination: "0.5 kg,
/// 2°, plunger". Text from a file: to be escaped.
std::string configuration_name(const core::AnalysisResults& results, const core::ConfigurationResult& configuration);

}  // namespace glidelab::report
