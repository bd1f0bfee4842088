/// What can be said of the whole program from its commands and options, as CLI11 holds them: a manual page. Nothing
/// here is written by hand twice.
#pragma once

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace glidelab::app {

/// The program's version, and on a second line the libraries it was built with.
std::string version_text();

/// A manual page of section 1 (roff, man(7)).
std::string man_page(const CLI::App& app);

}  // namespace glidelab::app
