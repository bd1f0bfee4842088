/// The files of a new experiment folder: an experiment.toml that explains every key, and a short README.
///
/// The folder's form is a contract with other programs (core/experiment/experiment.h reads it). Keys that a first
/// experiment does not need appear as comments "#key = value"; removing the # activates each of them (a test does so
/// one by one).
#pragma once

#include <string>
#include <string_view>

namespace glidelab::core {

/// experiment.toml of an experiment with two clips and a chessboard. `name` is the experiment's, any text.
std::string experiment_template(std::string_view name);

/// README.md: what to record, what goes where, which commands follow.
std::string experiment_readme(std::string_view name);

}  // namespace glidelab::core
