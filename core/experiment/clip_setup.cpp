#include "core/experiment/clip_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "base/math/angles.h"

namespace glidelab::core {
namespace {

constexpr double kLeastContradictionSds = 5.0;  // standard deviations between two readings of one angle

constexpr std::array<const char*, 4> kLaunchNames{"up", "down", "released", "unknown"};  // in the order of Launched
constexpr std::array<const char*, 3> kRecorderNames{"unstated", "sensor", "camera"};     // in the order of RecordedBy
constexpr std::array<const char*, 4> kDownhillNames{"+X", "-X", "+Y", "-Y"};             // in the order of Downhill

}  // namespace

int sign_of(Downhill downhill) {
  return downhill == Downhill::plus_x || downhill == Downhill::plus_y ? 1 : -1;
}

bool is_along_y(Downhill downhill) {
  return downhill == Downhill::plus_y || downhill == Downhill::minus_y;
}

std::string name_of(Launched launched) {
  return kLaunchNames.at(static_cast<std::size_t>(launched));
}

std::string name_of(RecordedBy by) {
  return kRecorderNames.at(static_cast<std::size_t>(by));
}

RecordedBy recorder_named(std::string_view name) {
  for (const RecordedBy by : {RecordedBy::sensor, RecordedBy::camera}) {
    if (name == name_of(by)) return by;
  }
  return RecordedBy::unstated;
}

std::string name_of(Downhill downhill) {
  return kDownhillNames.at(static_cast<std::size_t>(downhill));
}

bool is_fall(double incline_rad) {
  constexpr double kFall_rad = 80.0 * base::kRadPerDegree, kRounding_rad = 1e-9;
  return std::abs(incline_rad) >= kFall_rad - kRounding_rad;
}

bool contradicts(const ClipSetup& one, const ClipSetup& other) {
  if (!one.incline_sd_rad || !other.incline_sd_rad) return false;
  const double apart = std::abs(one.incline_rad - other.incline_rad);
  return apart > kSameIncline_rad + kLeastContradictionSds * std::hypot(*one.incline_sd_rad, *other.incline_sd_rad);
}

namespace {

std::string reading(const ClipSetup& clip) {
  return fmt::format("{:.6g} \xC2\xB1 {:.3g}", clip.incline_rad * base::kDegreesPerRad + 0.0,  // + 0.0: no "-0"
                     *clip.incline_sd_rad * base::kDegreesPerRad);
}

}  // namespace

std::string group_of_incline(double incline_rad) {
  return fmt::format("{:.6g} deg", incline_rad * base::kDegreesPerRad + 0.0);  // + 0.0: no "-0"
}

void name_groups(std::vector<ClipSetup>& clips) {
  std::set<double> inclinations;
  bool some_named = false;
  for (const ClipSetup& clip : clips) {
    if (clip.group.empty()) {
      inclinations.insert(clip.incline_rad);
    } else {
      some_named = true;
    }
  }
  for (ClipSetup& clip : clips) {
    if (!clip.group.empty()) continue;
    clip.group = inclinations.size() == 1 && !some_named ? "all" : group_of_incline(clip.incline_rad);
  }
}

void check_names(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables,
                 const std::vector<GroupSetup>& groups, const std::vector<base::TomlTable>& group_tables) {
  std::set<std::string> names;
  std::set<std::string> known_groups;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    known_groups.insert(clips[i].group);
    if (clips[i].name.empty() || names.insert(clips[i].name).second) continue;
    clip_tables[i].reject("name", fmt::format("text \"{}\" a second time", clips[i].name), "a name of its own");
  }
  names.clear();
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i].name.empty()) continue;
    if (!names.insert(groups[i].name).second) {
      group_tables[i].reject("name", fmt::format("text \"{}\" a second time", groups[i].name), "a name of its own");
    } else if (!known_groups.contains(groups[i].name)) {
      group_tables[i].reject("name", fmt::format("text \"{}\", a group without a clip", groups[i].name),
                             fmt::format("one of {}", fmt::join(known_groups, ", ")));
    }
  }
}

void check_readings(const std::vector<ClipSetup>& clips, const std::vector<base::TomlTable>& clip_tables) {
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const auto other = std::find_if(clips.begin(), clips.begin() + static_cast<long>(i), [&](const ClipSetup& earlier) {
      return earlier.group == clips[i].group && contradicts(earlier, clips[i]);
    });
    if (other == clips.begin() + static_cast<long>(i)) continue;
    clip_tables[i].reject("incline_deg", reading(clips[i]),
                          fmt::format("the inclination of group \"{}\", for which clip \"{}\" states {}; or a group "
                                      "of its own",
                                      clips[i].group, other->name, reading(*other)));
  }
}

}  // namespace glidelab::core
