/// What this program is: read from a header that changes with each commit, so that one small source alone is compiled
/// anew.
#pragma once

#include <string>

namespace glidelab::app {

/// The version, with the commit if it was built from a checkout: "1.0.0 (3f2a91c0)".
std::string build_version();

/// The program's version, and on a second line the libraries with which it was built.
std::string version_text();

}  // namespace glidelab::app
