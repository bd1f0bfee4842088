/// Reads a motion that was tracked elsewhere: a CSV with the header `t_s,x_m` or `t_s,x_m,force_n`, or what another
/// program exported (track_import.h).
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/track/track_data.h"

namespace glidelab::core {

/// Fewer points than this say nothing about an acceleration: a local cubic has four coefficients, and as many points
/// again are left for their noise.
inline constexpr std::size_t kFewestTrackPoints = 8;

/// Reads `file`; x and the force are multiplied by `downhill` (+1 or -1), so that both are positive downhill. Times
/// stay those of the file. InputError, up to ten issues named by line: no number, a time that does not rise, too few
/// points.
///
/// A file whose header has no `t_s`, or of which a column is asked for, goes to import_track().
TrackData read_track_csv(const std::filesystem::path& file, int downhill, const std::string& column = {});

/// Every point of a track from a file is a frame in which the object was seen; the frame rate is one over the median
/// time step.
void take_rows_as_frames(TrackData& track);

}  // namespace glidelab::core
