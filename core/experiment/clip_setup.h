/// The clips of an experiment, and the groups in which they share a set-up of the track and hence one inclination, as
/// plain data.
///
/// Every length is in metres, every time in seconds, every angle in radians; pixels are counted from the centre of the
/// image's first pixel. Nothing here needs an image library, so an analysis of tracks does without one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/toml/strict_toml.h"

namespace glidelab::core {

/// up: towards -x, down: towards +x, also on a level track; unknown: a track file on its own does not state it.
enum class Launched { up, down, released, unknown };

/// "up", "down", "released", as in experiment.toml, or "unknown".
std::string name_of(Launched launched);

/// What measured the positions of a track, as stated.
enum class RecordedBy { unstated, sensor, camera };

/// "sensor", "camera", as in experiment.toml, or "unstated".
std::string name_of(RecordedBy by);
/// "sensor" or "camera"; anything else is unstated.
RecordedBy recorder_named(std::string_view name);

/// Which direction is down (on a level track: positive): along X or Y of the pattern, of the image or of a project's
/// axes, or against it.
enum class Downhill { plus_x, minus_x, plus_y, minus_y };

/// +1 along the axis, -1 against it.
int sign_of(Downhill downhill);
bool is_along_y(Downhill downhill);
/// "+X", "-X", "+Y", "-Y", as in experiment.toml.
std::string name_of(Downhill downhill);

/// What turns a table that a program made of images into seconds and metres, where it counts frames and pixels.
struct ImageUnits {
  std::optional<double> frame_rate_hz;  ///< of its frame numbers
  std::optional<double> px_per_m;       ///< of its lengths in pixels
  double px_per_m_sd = 0.0;
  bool for_this_table = false;  ///< stated for one table, which is refused if it does not need them
};

struct PixelPoint {
  double x = 0.0, y = 0.0;
  bool operator==(const PixelPoint&) const = default;
};

struct PixelRegion {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelRegion&) const = default;
};

struct PlumbSetup {
  std::filesystem::path view;
  PixelRegion region;  ///< around the line
};

struct ClipSetup {
  std::string name;
  std::filesystem::path file;   ///< a video or a folder of frames; empty for a track
  std::filesystem::path track;  ///< a CSV `t_s,x_m[,force_n]`, an exported table or a Tracker project; empty for a clip
  std::string column = {};  ///< for an exported table the column of x, for a project the point mass: name or number;
                            ///< empty: found automatically
  RecordedBy recorded_by = RecordedBy::unstated;  ///< of a track
  ImageUnits image_units = {};                    ///< of an exported table
  double mass_kg = 0.0;
  double mass_sd_kg = 0.0;
  bool mass_assumed = false;     ///< for a file on its own: mass_kg is assumed, not stated
  double incline_rad = 0.0;      ///< as stated
  bool incline_assumed = false;  ///< for a file on its own: incline_rad is assumed, not stated, and no
                                 ///< motion contradicts it
  std::optional<double> incline_sd_rad;
  Launched launched = Launched::released;
  std::optional<double> start_s;
  std::optional<double> end_s;
  std::optional<PixelPoint> start_px = {};  ///< where its marker is at start_s, or in its first frame; in place of the
                                            ///< marker's own start_px
  std::string group;          ///< never empty once read: as given, otherwise one name for each stated inclination
  bool speeds_alone = false;  ///< its track may be a table of speeds without positions
};

/// The settings specific to a set-up; those left out come from [calibration], [plumb] and [track].
struct GroupSetup {
  std::string name;
  std::vector<std::filesystem::path> planes;
  std::optional<PlumbSetup> plumb;
  std::optional<Downhill> downhill;
};

/// Whether a motion on this stated inclination is a fall: from 80 degrees on, sin(alpha) is known to 0.3 % if alpha is
/// known to a degree, and the normal force is less than a sixth of the weight.
bool is_fall(double incline_rad);

inline constexpr double kSameIncline_rad = 1e-9;  ///< stated angles that differ by less are the same

/// Whether two readings of one inclination are further apart than five standard deviations of their difference. A clip
/// that states no uncertainty contradicts no other clip.
bool contradicts(const ClipSetup& one, const ClipSetup& other);

/// "4.3 deg": the name of a group that nobody named, where there are several.
std::string group_of_incline(double incline_rad);

/// Makes one group for each stated inclination among the clips that name no group; "all" if this makes one group in
/// all.
void name_groups(std::vector<ClipSetup>& clips);

/// Rejects names used for two clips or two groups, and groups without a clip. The tables are those of the clips and
/// groups.
void check_names(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables,
                 const std::vector<GroupSetup>& groups, const std::vector<base::TomlTable>& group_tables);

/// Rejects an inclination that another clip of the group contradicts(): a group has one inclination.
void check_readings(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables);

}  // namespace glidelab::core
