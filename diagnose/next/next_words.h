/// What to record next where an effect shows in images or single frames: a sentence with the physical reason.
#pragma once

#include <string>
#include <string_view>

namespace glidelab::diagnose {

/// Of an effect that shows in images or single frames; empty for one that shows in the motion.
std::string next_for_pictures(std::string_view id);

}  // namespace glidelab::diagnose
