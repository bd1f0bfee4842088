/// Track files as an alternative to experiment folders: a file with several runs, or several masses, becomes an
/// experiment with one clip for each.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>
#include "core/experiment/clip_setup.h"
#include "core/experiment/experiment.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// What the analysis needs besides a track file given on its own.
struct TrackFileOptions {
  std::string column;                 ///< of x in a table, or a point mass; empty: found
  std::optional<double> mass_kg;      ///< 1 kg if not stated; K/m, mu and alpha depend on it under a recorded force
  std::optional<double> incline_deg;  ///< as stated; level if not stated
  std::optional<double> incline_sd_deg = {};  ///< its standard deviation, with which it gives mu of one direction
  std::optional<double> gravity_m_s2 = {}, gravity_sd_m_s2 = {};  ///< as stated (stated_gravity())
  Permissions permitted = {};                                     ///< of a folder
  /// Which of the runs (or masses) of the file become clips: "all", or their numbers from 1 on, "1,3". Empty: the file
  /// is one clip.
  std::string runs = {};
  /// Of these runs, one each, or without `runs` of the files, one each (masses_of_files()); empty: mass_kg for all.
  std::vector<double> masses_kg = {};
  std::map<std::filesystem::path, double> mass_of_file = {};  ///< kg; of files that have their own
  RecordedBy recorded_by = RecordedBy::unstated;
  std::optional<double> frame_rate_hz = {};   ///< of a table that counts frames
  std::optional<double> px_per_m = {};        ///< of a table in pixels
  SpeedsAlone speeds = SpeedsAlone::refused;  ///< also of a folder
};

/// Gives each file its own mass if masses are stated and no runs. InputError if their numbers differ.
TrackFileOptions masses_of_files(TrackFileOptions options, const std::vector<std::filesystem::path>& files);

/// A regular file that is not experiment.toml.
bool is_bare_track(const std::filesystem::path& path);

/// One run of an exported table, or one point mass of a Tracker project.
struct TrackRun {
  std::string column;  ///< number of the column of x, from 1 on; or name of the point mass
  std::string label;   ///< "Run #2", "mass A"; the header if no run is stated
};

/// The columns named x or similar, in order, as read_track() finds them; or all point masses.
std::vector<TrackRun> runs_in(const std::filesystem::path& file);

/// For a folder, read_experiment(). For a file, an experiment of one clip, named after the file; with `runs`, one clip
/// for each run, named after it. x is taken as downhill. The launch is not known, so no motion is attributed to the
/// hand because of its direction alone. InputError as in read_experiment(), for a path that does not exist, for runs
/// that the file does not have, and if the numbers of masses and runs differ.
Experiment read_tracks(const std::filesystem::path& path, const TrackFileOptions& options);

/// Reads a motion that was tracked elsewhere, from any supported file.
///
/// For a Tracker project (looks_like_tracker_project()) read_tracker_project(), for any other file read_track_csv().
/// `column` is the point mass in the former case and the column in the latter. A table has no Y: `downhill` along Y is
/// an InputError there, and an empty value means that its x is positive downhill. InputError for units of images that
/// were stated for this file, which has seconds or metres of its own.
TrackData read_track(const std::filesystem::path& file, std::optional<Downhill> downhill, const std::string& column,
                     SpeedsAlone speeds = SpeedsAlone::refused, const ImageUnits& units = {});

}  // namespace glidelab::core
