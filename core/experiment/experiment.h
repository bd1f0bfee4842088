/// The experiment as it is given, as plain data: the folder that a person with a track, a glider and a camera has on
/// disk, or a track's file on its own.
///
/// The form of experiment.toml is a contract with other programs (experiment_template.h explains its keys). Angles are
/// converted to radians where the file is read; every length is in metres, every time in seconds.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/clip_setup.h"

namespace glidelab::core {

enum class Shutter { global, rolling };
enum class TimeSource { rate, container };

/// What the camera was told to do, or what its data sheet says.
struct CameraSettings {
  double frame_rate_hz = 0.0;
  std::optional<double> exposure_s;
  Shutter shutter = Shutter::global;
  double line_readout_s = 0.0;    ///< rolling: time from one row to the next
  bool bottom_row_first = false;  ///< rolling: the image's bottom row is read first; else its top row
  int bit_depth = 8;
  TimeSource time = TimeSource::rate;
};

/// Of a chessboard, in inner corners.
struct BoardSize {
  int columns = 0, rows = 0;
  bool operator==(const BoardSize&) const = default;
};

struct CalibrationSetup {
  BoardSize inner_corners;
  double square_m = 0.0;
  std::vector<std::filesystem::path> views;   ///< sorted by name
  std::vector<std::filesystem::path> planes;  ///< of the default set-up, sorted by name; the first one holds the origin
};

/// One scale for a clip without a pattern.
struct ScaleSetup {
  double px_per_m = 0.0;
  double px_per_m_sd = 0.0;
};

struct MarkerSetup {
  double diameter_m = 0.0;
  double height_m = 0.0;                                  ///< of its centre off the pattern's plane, towards the camera
  std::optional<std::array<unsigned char, 3>> color_bgr;  ///< blue, green, red
  std::optional<PixelPoint> start_px;
};

struct TrackSetup {
  int downhill = 1;  ///< +1 or -1: which direction of the pattern's X axis (the image's x, the file's x) is down
  std::optional<double> length_m;
};

/// A whole folder, checked. Paths are absolute or relative to the working directory, never to the folder.
struct Experiment {
  std::filesystem::path folder;
  std::filesystem::path file;  ///< of experiment.toml, for messages
  std::string name;
  double gravity_m_s2 = 9.80665;
  std::optional<CameraSettings> camera;
  std::optional<CalibrationSetup> calibration;
  std::optional<ScaleSetup> scale;
  std::optional<PlumbSetup> plumb;
  std::optional<MarkerSetup> marker;
  TrackSetup track;
  std::vector<ClipSetup> clips;
  std::vector<GroupSetup> groups;              ///< one for each [[group]]
  std::optional<std::filesystem::path> lines;  ///< a table of fitted lines instead of clips
};

/// Reads and checks `folder`/experiment.toml. InputError with all that is wrong: missing, misspelt, mistyped, out of
/// range, files that are not there, clips that need a section which is missing, names used twice.
Experiment read_experiment(const std::filesystem::path& folder, OutsideFiles outside = OutsideFiles::refused);

/// InputError where there is neither a clip nor a track: a table of lines is for `glidelab diagnose`.
void require_clips(const Experiment& experiment);

/// What the analysis needs beside a track's file that is given on its own.
struct BareTrackOptions {
  std::string column;                 ///< of x in an exported table (track_data.h); empty: found by its header
  std::optional<double> mass_kg;      ///< K/m, mu and alpha do not depend on it; 1 kg stands for what is not stated
  std::optional<double> incline_deg;  ///< as stated; level where it is not. It names the configuration, no more
  OutsideFiles outside = OutsideFiles::refused;  ///< of a folder: whether it may name files outside (file_names.h)
};

/// A regular file that is not experiment.toml.
bool is_bare_track(const std::filesystem::path& path);

/// Of a folder read_experiment(); of a file an experiment of one clip, named after the file, x taken as downhill, how
/// it was launched not known: no motion is the hand's for its direction alone.
/// InputError as read_experiment(), and for a path that is not there.
Experiment read_input(const std::filesystem::path& path, const BareTrackOptions& options);

}  // namespace glidelab::core
