/// A scenario as given by Python: a file, or the text into which a dict was converted.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "render/scenario/scenario.h"

namespace glidelab::python {

/// (file, text): without a text the file is read; with one, `file` is its name in messages, and a camera file is
/// relative to its folder.
using GivenScenario = std::pair<std::string, std::optional<std::string>>;

/// InputError as in render::read_scenario().
render::Scenario read_scenario(const GivenScenario& given, render::ScenarioChecks checks = render::ScenarioChecks::all);

/// Its text.
std::string text_of(const GivenScenario& given);

}  // namespace glidelab::python
