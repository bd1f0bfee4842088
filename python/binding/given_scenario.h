/// A scenario as Python gives it: a file, or the text of one that a dict was written as.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "render/scenario/scenario.h"

namespace glidelab::python {

/// (file, text): without a text the file is read; with one, `file` is what messages call it, and a camera file counts
/// from its folder.
using GivenScenario = std::pair<std::string, std::optional<std::string>>;

/// InputError as render::read_scenario().
render::Scenario read_scenario(const GivenScenario& given, render::ScenarioChecks checks = render::ScenarioChecks::all);

/// Its text.
std::string text_of(const GivenScenario& given);

}  // namespace glidelab::python
