/// A track from a table that another program exported (column_table.h): which column is x, which is its time.
///
/// x is the column that is asked for, by its header, its name or its number from 1 on; otherwise the one that is called
/// x, position, distance or displacement (or the like in German, French, Spanish), if there is just one. Its time is
/// the nearest column to the left that is called t or time or has a unit of time, of the same run where runs are
/// stated; else the only one there is. In a file without header the first column is the time. Units: m, dm, cm, mm, um,
/// km, in, ft; s, ms, us, min. Where none is stated metres and seconds are taken, and a note says so. Rows without time
/// or x are left out (columns of several runs differ in length), and a note counts those that lie between others.
#pragma once

#include <filesystem>
#include <string>

#include "core/track/track_data.h"

namespace glidelab::core {

/// x is multiplied by `downhill`. InputError: no or several columns that x may be, a unit that is no length or time,
/// times that do not rise, fewer points than kFewestTrackPoints.
TrackData import_track(const std::filesystem::path& file, const std::string& column, int downhill);

}  // namespace glidelab::core
