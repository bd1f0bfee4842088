/// Texts of the whole program, generated from its commands and options in CLI11: completion for shells, and a manual
/// page. Nothing is written by hand twice.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace glidelab::app {

/// The words that the option accepts; none if it takes something else.
std::vector<std::string> words_of(const CLI::Option& option);

/// A check that an option is one of these words; otherwise it says what was found and which word may have been meant.
CLI::Validator one_of(const std::vector<std::string>& words);

/// The option's type as help and manual show it: its words if they are few.
std::string shown_type(const CLI::Option& option);

/// A script that completes commands, options, their words and files: for "bash" (to be sourced, or put among
/// bash-completion/completions) or "zsh" (a file _glidelab on its fpath).
std::string completion_script(const CLI::App& app, const std::string& shell);

/// A manual page of section 1 (roff, man(7)).
std::string man_page(const CLI::App& app);

}  // namespace glidelab::app
