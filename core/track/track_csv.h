/// Reads a motion that was tracked elsewhere: a CSV with the header `t_s,x_m` or `t_s,x_m,force_n`, or what another
/// program exported (track_import.h).
#pragma once

#include <filesystem>
#include <string>

#include "core/track/track_data.h"

namespace glidelab::core {

/// Reads `file`; x and the force are multiplied by `downhill` (+1 or -1), so that both are positive downhill. Times
/// stay those of the file. InputError, up to ten issues named by line: no number, a time that does not rise, too few
/// points.
///
/// A file whose header has no `t_s`, or of which a column is asked for, goes to import_track().
TrackData read_track_csv(const std::filesystem::path& file, int downhill, const std::string& column = {});

}  // namespace glidelab::core
