/// What the commands that take recordings (analyze, check, diagnose) have in common.
#pragma once

#include <string>
#include <vector>

#include "core/experiment/folder_files.h"

namespace CLI {
class App;
}

namespace glidelab::app {

/// Adds --allow-outside, which sets `outside`.
void add_allow_outside(CLI::App& command, core::OutsideFiles& outside);

/// InputError if one of these is a scenario or a sweep, which hold no recording.
void refuse_scenarios(const std::vector<std::string>& inputs);

}  // namespace glidelab::app
