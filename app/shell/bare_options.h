/// Options of the commands that take a track's file beside experiment folders (analyze, check, diagnose, certify): what
/// the file does not say.
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

/// Options for files have no meaning for folders, whose experiment.toml says the same: InputError where an input is a
/// folder and one of them is given; and for --masses without --runs, or beside --mass.
void check_bare_options(const core::TrackFileOptions& options, const std::vector<std::string>& inputs);

}  // namespace glidelab::app
