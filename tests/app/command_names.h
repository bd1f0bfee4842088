/// All commands, for what must hold of each.
#pragma once

#include <string>
#include <vector>

namespace glidelab::tests {

inline const std::vector<std::string> kCommands = {
    "simulate",     "render",   "analyze", "validate", "coverage", "certify", "sweep",   "require",  "laws",
    "characterize", "diagnose", "blind",   "new",      "pattern",  "check",   "explore", "challenge"};

}  // namespace glidelab::tests
