/// The clips of an experiment, and the groups in which they share a set-up of the track and so one inclination, as
/// plain data.
///
/// Every length is in metres, every time in seconds, every angle in radians; pixels are counted from the centre of the
/// image's first pixel. Nothing here needs a picture library, so that an analysis of tracks does without one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/toml/strict_toml.h"

namespace glidelab::core {

/// up: towards -x, down: towards +x, also on a level track; unknown: a track file on its own, which does not say.
enum class Launched { up, down, released, unknown };

/// "up", "down", "released", as experiment.toml says it, or "unknown".
std::string name_of(Launched launched);

/// Which direction is down (on a level track: positive): along X or Y of the pattern, of the image or of a project's
/// axes, or against it.
enum class Downhill { plus_x, minus_x, plus_y, minus_y };

/// +1 along the axis, -1 against it.
int sign_of(Downhill downhill);
bool is_along_y(Downhill downhill);
/// "+X", "-X", "+Y", "-Y", as experiment.toml says it.
std::string name_of(Downhill downhill);

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
  std::string column =
      {};  ///< of an exported table the column that is x, of a project the point mass: name or number; empty: found
  double mass_kg = 0.0;
  double mass_sd_kg = 0.0;
  bool mass_assumed = false;  ///< of a file on its own: mass_kg stands for what nobody states
  double incline_rad = 0.0;   ///< as stated
  std::optional<double> incline_sd_rad;
  Launched launched = Launched::released;
  std::optional<double> start_s;
  std::optional<double> end_s;
  std::string group;  ///< never empty once read: as given, else one name for each stated inclination
};

/// What a set-up has of its own; what it leaves out comes from [calibration], [plumb] and [track].
struct GroupSetup {
  std::string name;
  std::vector<std::filesystem::path> planes;
  std::optional<PlumbSetup> plumb;
  std::optional<Downhill> downhill;
};

inline constexpr double kSameIncline_rad = 1e-9;  ///< stated angles that differ by less are the same

/// Whether two readings of one inclination are further apart than five standard deviations of their difference. A clip
/// that states no uncertainty contradicts no other.
bool contradicts(const ClipSetup& one, const ClipSetup& other);

/// One group for each stated inclination among the clips that name none; "all" where that makes one group in all.
void name_groups(std::vector<ClipSetup>& clips);

/// Rejects names that two clips or two groups have, and groups without a clip. The tables belong to the clips and
/// groups.
void check_names(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables,
                 const std::vector<GroupSetup>& groups, const std::vector<base::TomlTable>& group_tables);

/// Rejects an inclination that another clip of the group contradicts(): a group has one.
void check_readings(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables);

/// Whether the inclination of a clip is that of a file on its own (nobody says how it was launched) that stands for
/// what nobody states, 0: no motion contradicts it.
bool incline_is_assumed(const ClipSetup& clip);

}  // namespace glidelab::core
