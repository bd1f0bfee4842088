/// How a long computation reports its progress, and how it is stopped.
#pragma once

#include <functional>
#include <string_view>

namespace glidelab::base {

/// Called with what is being done and how much of it (0 to 1). May be called from several threads at once.
/// May throw Interrupted, which ends the work and cleans up.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Reports nothing and never stops.
inline void no_progress(std::string_view, double) {}

}  // namespace glidelab::base
