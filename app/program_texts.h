/// What can be said of the whole program from its commands and options, as CLI11 holds them: a manual page, and
/// completion for shells. Nothing here is written by hand twice.
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace glidelab::app {

/// The program's version, and on a second line the libraries it was built with.
std::string version_text();

/// A manual page of section 1 (roff, man(7)).
std::string man_page(const CLI::App& app);

/// A script that completes commands, options and files: for "bash" (to be sourced, or put among
/// bash-completion/completions) or "zsh" (a file _glidelab on its fpath).
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace glidelab::app
