/// Options of the commands that accept a track file as well as experiment folders (analyze, check, diagnose, certify):
/// what the file does not state.
#pragma once

#include <string>
#include <vector>

#include "core/track/bare_track.h"

namespace CLI {
class App;
}  // namespace CLI

namespace glidelab::app {

/// --column, --mass, --incline, --runs, --masses, and, for folders, --allow-outside and --max-megapixels.
void add_bare_options(CLI::App& command, core::TrackFileOptions& options);

/// Options for files have no meaning for folders, whose experiment.toml states the same: InputError if an input is a
/// folder and one of them is given, for --masses without --runs, and for --masses with --mass.
void check_bare_options(const core::TrackFileOptions& options, const std::vector<std::string>& inputs);

}  // namespace glidelab::app
