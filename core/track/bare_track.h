/// Files with tracks beside experiment folders: a file that holds several runs, or several masses, makes an experiment
/// of one clip for each.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"

namespace glidelab::core {

/// What the analysis needs beside a track's file that is given on its own.
struct TrackFileOptions : BareTrackOptions {
  /// Which of the runs (or masses) of the file become clips: "all", or their numbers from 1 on, "1,3". Empty: the file
  /// is one clip.
  std::string runs = {};
  std::vector<double> masses_kg = {};  ///< of these runs, one each; empty: mass_kg of all
};

/// One run of an exported table, or one point mass of a Tracker project.
struct TrackRun {
  std::string column;  ///< number of the column of x, from 1 on; or name of the point mass
  std::string label;   ///< "Run #2", "mass A"; the header where no run is stated
};

/// The columns that are called x or the like, in their order, as read_track() finds them; or all point masses.
std::vector<TrackRun> runs_in(const std::filesystem::path& file);

/// A folder, or a file of one clip, as read_input() has it; of a file with `runs` one clip for each, named after it.
/// InputError as read_input(), for runs that the file does not have, and for another number of masses than of runs.
Experiment read_tracks(const std::filesystem::path& path, const TrackFileOptions& options);

}  // namespace glidelab::core
