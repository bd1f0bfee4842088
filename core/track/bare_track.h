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
struct TrackFileOptions {
  std::string column;  ///< of x in a table, or a point mass (read_track.h); empty: found
  std::optional<double>
      mass_kg;  ///< 1 kg stands for what is not stated; K/m, mu and alpha depend on it under a recorded force
  std::optional<double> incline_deg;  ///< as stated; level where it is not. It names the configuration, no more
  Permissions permitted = {};         ///< of a folder
  /// Which of the runs (or masses) of the file become clips: "all", or their numbers from 1 on, "1,3". Empty: the file
  /// is one clip.
  std::string runs = {};
  std::vector<double> masses_kg = {};  ///< of these runs, one each; empty: mass_kg of all
};

/// A regular file that is not experiment.toml.
bool is_bare_track(const std::filesystem::path& path);

/// One run of an exported table, or one point mass of a Tracker project.
struct TrackRun {
  std::string column;  ///< number of the column of x, from 1 on; or name of the point mass
  std::string label;   ///< "Run #2", "mass A"; the header where no run is stated
};

/// The columns that are called x or the like, in their order, as read_track() finds them; or all point masses.
std::vector<TrackRun> runs_in(const std::filesystem::path& file);

/// Of a folder read_experiment(). Of a file an experiment of one clip, named after the file, or with `runs` of one clip
/// for each, named after it: x is taken as downhill, and how it was launched is not known, so that no motion is the
/// hand's for its direction alone. InputError as read_experiment(), for a path that is not there, for runs that the
/// file does not have, and for another number of masses than of runs.
Experiment read_tracks(const std::filesystem::path& path, const TrackFileOptions& options);

}  // namespace glidelab::core
