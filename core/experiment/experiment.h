/// The experiment folder as plain data: what a person with a track, a glider and a camera has on disk.
///
/// The form of experiment.toml is a contract with other programs (experiment_template.h explains its keys). Angles are
/// converted to radians where the file is read; every length is in metres, every time in seconds.
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidelab::core {

enum class Shutter { global, rolling };
enum class TimeSource { rate, container };
/// up: towards -x, down: towards +x, also on a level track; unknown: a file of a track alone, of which nobody said it.
enum class Launched { up, down, released, unknown };

/// What the camera was told to do, or what its data sheet says.
struct CameraSettings {
  double frame_rate_hz = 0.0;
  std::optional<double> exposure_s;
  Shutter shutter = Shutter::global;
  double line_readout_s = 0.0;    ///< rolling: time from one row to the next
  bool bottom_row_first = false;  ///< rolling: the picture's bottom row is read first; else its top row
  int bit_depth = 8;
  TimeSource time = TimeSource::rate;
};

struct CalibrationSetup {
  cv::Size inner_corners;  ///< as OpenCV counts them: columns, rows
  double square_m = 0.0;
  std::vector<std::filesystem::path> views;   ///< sorted by name
  std::vector<std::filesystem::path> planes;  ///< of the default set-up, sorted by name; the first one holds the origin
};

/// One scale for a clip without a pattern.
struct ScaleSetup {
  double px_per_m = 0.0;
  double px_per_m_sd = 0.0;
};

struct PlumbSetup {
  std::filesystem::path view;
  cv::Rect region;  ///< pixels around the line
};

struct MarkerSetup {
  double diameter_m = 0.0;
  double height_m = 0.0;  ///< of its centre off the pattern's plane, towards the camera
  std::optional<cv::Vec3b> color_bgr;
  std::optional<cv::Point2d> start_px;
};

struct TrackSetup {
  int downhill = 1;  ///< +1 or -1: which way along the pattern's X axis (the image's x, the file's x) is down
  std::optional<double> length_m;
};

struct ClipSetup {
  std::string name;
  std::filesystem::path file;   ///< a video or a folder of frames; empty for a track
  std::filesystem::path track;  ///< a CSV `t_s,x_m[,force_n]` or an exported table; empty for a clip
  std::string column = {};      ///< of an exported table, that is x: its header or number; empty: found by its header
  double mass_kg = 0.0;
  double mass_sd_kg = 0.0;
  double incline_rad = 0.0;  ///< as stated
  std::optional<double> incline_sd_rad;
  Launched launched = Launched::released;
  std::optional<double> start_s;
  std::optional<double> end_s;
  std::string group;  ///< never empty once read: as given, else one name for each stated inclination
};

inline constexpr double kSameIncline_rad = 1e-9;  ///< stated angles that differ by less are one

/// Whether two readings of one inclination are further apart than five standard deviations of both together. A clip
/// that states no uncertainty contradicts nobody.
bool contradicts(const ClipSetup& one, const ClipSetup& other);

/// What a set-up has of its own; what it leaves out comes from [calibration], [plumb] and [track].
struct GroupSetup {
  std::string name;
  std::vector<std::filesystem::path> planes;
  std::optional<PlumbSetup> plumb;
  std::optional<int> downhill;
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
Experiment read_experiment(const std::filesystem::path& folder);

}  // namespace glidelab::core
