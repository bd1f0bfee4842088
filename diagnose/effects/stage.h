/// Where between the world and the result an effect acts.
#pragma once

#include <string_view>

namespace glidelab::diagnose {

enum class Stage { dynamics, optics, timing, sensor, tracking, analysis };

/// As files and pages have it: "dynamics".
std::string_view to_text(Stage stage);

}  // namespace glidelab::diagnose
