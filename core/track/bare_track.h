/// An input of a command that takes experiment folders or tracks' files: a folder is read as it is, a file makes an
/// experiment of its own, of one clip, or of one for each run that the file holds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"

namespace glidelab::core {

/// What the analysis needs beside a track's file that is given on its own.
struct BareTrackOptions {
  std::string column;                 ///< of x in an exported table (track_data.h); empty: found by its header
  std::optional<double> mass_kg;      ///< K/m, mu and alpha do not depend on it; 1 kg stands for what is not stated
  std::optional<double> incline_deg;  ///< as stated; level where it is not. It names the configuration, no more
  OutsideFiles outside = OutsideFiles::refused;  ///< of a folder: whether it may name files outside (file_names.h)
  /// Which of the runs (or masses) of the file become clips: "all", or their numbers from 1 on, "1,3". Empty: the file
  /// is one clip.
  std::string runs = {};
  std::vector<double> masses_kg = {};  ///< of these runs, one each; empty: mass_kg of all
};

/// One run of an exported table: its x and its label.
struct TrackRun {
  std::size_t column = 0;  ///< of x, from 1 on
  std::string label;       ///< "Run #2", "mass A"; the header where no run is stated
};

/// The columns that are called x or the like, in their order; as import_track() finds them.
std::vector<TrackRun> runs_in(const std::filesystem::path& file);

/// A regular file that is not experiment.toml.
bool is_bare_track(const std::filesystem::path& path);

/// Of a folder read_experiment(); of a file an experiment of one clip, named after the file, or of one for each of the
/// runs that are asked for, named after these; x taken as downhill, how it was launched not known: no motion is the
/// hand's for its direction alone. InputError as read_experiment(), for a path that is not there, for runs that the
/// file does not have, and for another number of masses than of runs.
Experiment read_input(const std::filesystem::path& path, const BareTrackOptions& options);

}  // namespace glidelab::core
