/// A scenario from its TOML file (docs/reference/scenario.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "render/scenario/scenario_data.h"

namespace glidelab::render {

/// Reads a whole scenario file. InputError with everything that is wrong with it, among it what makes no physical
/// sense: an exposure longer than the frame time, a lens that folds the image over, a marker that gets behind the
/// camera or is never seen, a pattern that does not fit into the image.
Scenario read_scenario(const std::filesystem::path& path);

/// How much of a scenario's text is checked: everything, or all but what the camera sees of it (for who makes no
/// images of it).
enum class ScenarioChecks { all, values };

/// The same of a text, as if it stood in the file `path`.
Scenario read_scenario(std::string_view text, const std::filesystem::path& path,
                       ScenarioChecks checks = ScenarioChecks::all);

}  // namespace glidelab::render
