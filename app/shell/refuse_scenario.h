/// What a command says that wants a recording and is given a scenario.
#pragma once

#include <string>
#include <vector>

namespace glidelab::app {

/// InputError where one of these is a scenario or a sweep, which hold no recording.
void refuse_scenarios(const std::vector<std::string>& inputs);

}  // namespace glidelab::app
