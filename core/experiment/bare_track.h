/// What the analysis is given: an experiment folder, or a track's file on its own, for which options say what the
/// analysis needs beside it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/experiment/experiment.h"

namespace glidelab::core {

struct BareTrackOptions {
  std::string column;                 ///< of x in an exported table (track_import.h); empty: found by its header
  std::optional<double> mass_kg;      ///< K/m, mu and alpha do not depend on it; 1 kg stands for what is not stated
  std::optional<double> incline_deg;  ///< as stated; level where it is not. It names the configuration, no more
  OutsideFiles outside = OutsideFiles::refused;  ///< of a folder: whether it may name files outside (folder_files.h)
};

/// A regular file that is not experiment.toml.
bool is_bare_track(const std::filesystem::path& path);

/// Of a folder read_experiment(); of a file an experiment of one clip, named after the file, x taken as downhill, how
/// it was launched not known: no motion is the hand's for its direction alone.
/// InputError as read_experiment(), and for a path that is not there.
Experiment read_input(const std::filesystem::path& path, const BareTrackOptions& options);

}  // namespace glidelab::core
