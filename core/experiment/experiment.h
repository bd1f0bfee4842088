/// The experiment as given, as plain data: the folder of a user with a track, a glider and a camera, or a track file on
/// its own.
///
/// The form of experiment.toml is a contract with other programs (experiment_template.h explains its keys). Angles are
/// converted to radians when the file is read; every length is in metres, every time in seconds.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/experiment/local_gravity.h"
#include "core/experiment/permissions.h"

namespace glidelab::core {

enum class Shutter { global, rolling };
enum class TimeSource { rate, container };

/// The camera's settings, or the values of its data sheet.
struct CameraSettings {
  double frame_rate_hz = 0.0;
  std::optional<double> exposure_s;
  Shutter shutter = Shutter::global;
  double line_readout_s = 0.0;    ///< rolling: time from one row to the next
  bool bottom_row_first = false;  ///< rolling: the image's bottom row is read first; otherwise its top row
  int bit_depth = 8;
  TimeSource time = TimeSource::rate;
  std::size_t most_pixels = kMostPixels;  ///< in one of its images: a larger one is refused
};

/// Size of a chessboard, in inner corners.
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
  double height_m = 0.0;                                  ///< of its centre above the pattern's plane, towards the
                                                          ///< camera
  std::optional<std::array<unsigned char, 3>> color_bgr;  ///< blue, green, red
  std::optional<PixelPoint> start_px;
};

struct TrackSetup {
  std::optional<Downhill> downhill;  ///< for all groups that state none; a folder of tracks may leave it out
  std::optional<double> length_m;
};

/// A whole folder, checked. Paths are absolute or relative to the working directory, never to the folder.
struct Experiment {
  std::filesystem::path folder;
  std::filesystem::path file;  ///< of experiment.toml, for messages
  std::string name;
  double gravity_m_s2 = kStandardGravity_m_s2;
  double gravity_sd_m_s2 = kLocalGravity_sd_m_s2;  ///< as stated, otherwise by stated_gravity()
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

/// Reads and checks `folder`/experiment.toml. InputError with all errors: keys that are missing, misspelt, of wrong
/// type or out of range, files that do not exist, clips that need a missing section, names used twice.
Experiment read_experiment(const std::filesystem::path& folder, Permissions permitted = {});

/// The table of a group, or null if the file has none.
const GroupSetup* group_of(const Experiment& experiment, const std::string& name);

/// Which direction is down, from the group or else from [track]; empty if neither states it.
std::optional<Downhill> downhill_of(const Experiment& experiment, const std::string& group);

/// The marker as it is in this clip: with the clip's start_px, if it has one. The experiment states a marker.
MarkerSetup marker_in(const Experiment& experiment, const ClipSetup& clip);

/// InputError if there is neither a clip nor a track: a table of lines is for `glidelab diagnose`.
void require_clips(const Experiment& experiment);

/// The largest number of pixels of one of its images, as permitted when it was read.
std::size_t most_pixels_of(const Experiment& experiment);

}  // namespace glidelab::core
