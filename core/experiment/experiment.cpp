#include "core/experiment/experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/math/angles.h"
#include "base/toml/strict_toml.h"
#include "core/experiment/clip_setup.h"
#include "core/experiment/file_names.h"

namespace glidelab::core {
namespace fs = std::filesystem;
using base::TomlTable;

namespace {

constexpr long kLargestImagePx = 100000;  // larger than any sensor; keeps rectangles within int

CameraSettings read_camera(const TomlTable& table) {
  CameraSettings camera;
  camera.frame_rate_hz = table.number("frame_rate_hz", base::above(0.0));
  camera.exposure_s = table.maybe_number("exposure_s", base::above(0.0));
  camera.shutter =
      table.word("shutter", {"global", "rolling"}, "global") == "rolling" ? Shutter::rolling : Shutter::global;
  camera.line_readout_s = camera.shutter == Shutter::rolling
                              ? table.number("line_readout_s", base::at_least(0.0))
                              : table.number_or("line_readout_s", 0.0, base::at_least(0.0));
  camera.bottom_row_first = table.word("first_row", {"top", "bottom"}, "top") == "bottom";
  if (camera.shutter == Shutter::global && camera.bottom_row_first) {
    table.reject("first_row", "\"bottom\" with a global shutter", "shutter = \"rolling\"");
  }
  camera.bit_depth = static_cast<int>(table.integer_or("bit_depth", 8, 8, 16));
  camera.time =
      table.word("time", {"rate", "container"}, "rate") == "container" ? TimeSource::container : TimeSource::rate;
  if (camera.shutter == Shutter::global && camera.line_readout_s > 0.0) {
    table.reject("line_readout_s", fmt::format("{} with a global shutter", camera.line_readout_s),
                 "0, or shutter = \"rolling\"");
  }
  // One frame's exposure ends before the next one's starts; 1 % for rates that are stated rounded (240 for 239.76).
  if (camera.exposure_s && *camera.exposure_s * camera.frame_rate_hz > 1.01) {
    table.reject("exposure_s", fmt::format("{}", *camera.exposure_s),
                 fmt::format("at most the time from one frame to the next, {:.6g} s", 1.0 / camera.frame_rate_hz));
  }
  return camera;
}

CalibrationSetup read_calibration(const TomlTable& table, const FolderFiles& folder) {
  CalibrationSetup setup;
  table.word("pattern", {"chessboard"});
  const std::vector<double> corners = table.numbers("inner_corners", 2, base::between(3, 100));
  if (std::all_of(corners.begin(), corners.end(), [](double n) { return n == std::floor(n); })) {
    setup.inner_corners = {static_cast<int>(corners[0]), static_cast<int>(corners[1])};
  } else if (std::isfinite(corners[0])) {
    table.reject("inner_corners", fmt::format("[{}, {}]", corners[0], corners[1]), "two whole numbers");
  }
  setup.square_m = table.number("square_m", base::above(0.0));
  setup.views = folder.files(table, "views");
  if (table.has("plane")) setup.planes = folder.files(table, "plane");
  return setup;
}

ScaleSetup read_scale(const TomlTable& table) {
  ScaleSetup setup;
  const bool from_points = table.has("from_px") || table.has("to_px") || table.has("length_m");
  const double sd = table.number_or("px_per_m_sd", 0.0, base::at_least(0.0));
  if (!from_points) {
    setup.px_per_m = table.number("px_per_m", base::above(0.0));
    setup.px_per_m_sd = sd;
    return setup;
  }
  if (table.has("px_per_m")) {
    table.reject("px_per_m", "a value together with from_px, to_px and length_m", "either px_per_m or those three");
  }
  const std::vector<double> from = table.numbers("from_px", 2);
  const std::vector<double> to = table.numbers("to_px", 2);
  const double length_m = table.number("length_m", base::above(0.0));
  const double length_px = std::hypot(to[0] - from[0], to[1] - from[1]);
  if (length_px == 0.0) table.reject("to_px", "the same point as from_px", "another point");
  setup.px_per_m = length_px / length_m;
  // Both ends are read off the image to one pixel; a given value counts instead.
  setup.px_per_m_sd = table.has("px_per_m_sd") ? sd : std::numbers::sqrt2 / length_m;
  return setup;
}

PlumbSetup read_plumb(const TomlTable& table, const FolderFiles& folder) {
  PlumbSetup setup;
  setup.view = folder.file(table, "view");
  const std::vector<double> region = table.numbers("region", 4, base::between(0, kLargestImagePx));
  if (!std::isfinite(region[0])) return setup;
  if (region[2] < 3.0 || region[3] < 3.0) {
    table.reject("region", fmt::format("{} x {} pixels", region[2], region[3]),
                 "a width and a height of at least 3 pixels");
  }
  const auto whole = [](double value) { return static_cast<int>(std::lround(value)); };
  setup.region = {whole(region[0]), whole(region[1]), whole(region[2]), whole(region[3])};
  return setup;
}

std::optional<std::array<unsigned char, 3>> read_color(const TomlTable& table) {
  const std::optional<std::string> text = table.maybe_text("color");
  if (!text || text->empty()) return std::nullopt;
  const bool is_hex =
      text->size() == 7 && text->front() == '#' &&
      std::all_of(text->begin() + 1, text->end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
  if (!is_hex) {
    table.reject("color", fmt::format("text \"{}\"", *text), "a colour \"#rrggbb\"");
    return std::nullopt;
  }
  const unsigned long rgb = std::stoul(text->substr(1), nullptr, 16);
  const auto byte = [rgb](int shift) { return static_cast<unsigned char>((rgb >> shift) & 0xff); };
  return std::array<unsigned char, 3>{byte(0), byte(8), byte(16)};
}

std::optional<PixelPoint> read_start(const TomlTable& table) {
  const auto start = table.maybe_numbers("start_px", 2, base::at_least(0.0));
  if (!start) return std::nullopt;
  return PixelPoint{(*start)[0], (*start)[1]};
}

MarkerSetup read_marker(const TomlTable& table) {
  MarkerSetup setup;
  setup.diameter_m = table.number("diameter_m", base::above(0.0));
  setup.height_m = table.number_or("height_m", 0.0);
  setup.color_bgr = read_color(table);
  setup.start_px = read_start(table);
  return setup;
}

Downhill read_downhill(const TomlTable& table) {
  using enum Downhill;
  const std::string word =
      table.word("downhill", {name_of(plus_x), name_of(minus_x), name_of(plus_y), name_of(minus_y)});
  for (const Downhill downhill : {minus_x, plus_y, minus_y}) {
    if (word == name_of(downhill)) return downhill;
  }
  return plus_x;
}

Launched read_launched(const TomlTable& table) {
  using enum Launched;
  const std::string word = table.word("launched", {name_of(up), name_of(down), name_of(released)});
  for (const Launched launched : {up, down}) {
    if (word == name_of(launched)) return launched;
  }
  return released;
}

RecordedBy read_recorder(const TomlTable& root) {
  using enum RecordedBy;
  if (!root.has("recorded_by")) return unstated;
  return recorder_named(root.word("recorded_by", {name_of(sensor), name_of(camera)}));
}

ClipSetup read_clip(const TomlTable& table, const FolderFiles& folder) {
  ClipSetup clip;
  clip.name = table.text("name");
  // The name becomes part of file names (phase-NAME.csv).
  if (clip.name.find_first_of("/\\") != std::string::npos ||
      std::any_of(clip.name.begin(), clip.name.end(), [](unsigned char c) { return c < 0x20; })) {
    table.reject("name", fmt::format("text \"{}\"", clip.name), "a name without slashes and control characters");
  }
  if (table.has("file") && table.has("track")) {
    table.reject("track", "a track and a file", "either file or track");
  }
  if (table.has("track")) {
    clip.track = folder.file(table, "track");
    clip.column = table.maybe_text("column").value_or("");
    if (table.has("file"))
      clip.file = folder.folder / table.text("file");  // already an error; the missing sections are reported
  } else {
    clip.file = folder.file(table, "file", true);
  }
  clip.mass_kg = table.number("mass_kg", base::above(0.0));
  clip.mass_sd_kg = table.number_or("mass_sd_kg", 0.0, base::at_least(0.0));
  clip.incline_rad = table.number("incline_deg", base::between(-90.0, 90.0)) * base::kRadPerDegree;
  if (const auto sd_deg = table.maybe_number("incline_sd_deg", base::at_least(0.0))) {
    clip.incline_sd_rad = *sd_deg * base::kRadPerDegree;
  }
  clip.launched = read_launched(table);
  clip.start_s = table.maybe_number("start_s");
  clip.end_s = table.maybe_number("end_s");
  if (clip.start_s && clip.end_s && *clip.start_s >= *clip.end_s) {
    table.reject("end_s", fmt::format("{}", *clip.end_s), fmt::format("a time after start_s = {}", *clip.start_s));
  }
  clip.start_px = read_start(table);
  if (clip.start_px && !clip.track.empty()) table.reject("start_px", "a place in an image for a track", "nothing");
  clip.group = table.maybe_text("group").value_or("");
  return clip;
}

GroupSetup read_group(const TomlTable& table, const FolderFiles& folder) {
  GroupSetup group;
  group.name = table.text("name");
  if (table.has("plane")) group.planes = folder.files(table, "plane");
  if (const auto plumb = table.maybe_table("plumb")) group.plumb = read_plumb(*plumb, folder);
  if (table.has("downhill")) group.downhill = read_downhill(table);
  return group;
}

bool stated_by_all_groups(const Experiment& experiment, bool only_images, bool (*states)(const GroupSetup&)) {
  return std::all_of(experiment.clips.begin(), experiment.clips.end(), [&](const ClipSetup& clip) {
    if (only_images && clip.file.empty()) return true;
    return std::any_of(experiment.groups.begin(), experiment.groups.end(),
                       [&](const GroupSetup& group) { return group.name == clip.group && states(group); });
  });
}

/// Checks the sections that clips with images require.
void check_sections(const Experiment& experiment, const TomlTable& root) {
  if (experiment.calibration && experiment.scale) {
    root.reject("scale", "a table [scale] and a table [calibration]", "one of the two");
  }
  const auto image = std::find_if(experiment.clips.begin(), experiment.clips.end(),
                                  [](const ClipSetup& clip) { return !clip.file.empty(); });
  if (image == experiment.clips.end()) return;
  const std::string needed_by = fmt::format("for clip \"{}\"", image->name);
  if (!experiment.camera) root.reject("camera", "nothing", fmt::format("a table [camera], {}", needed_by));
  if (!experiment.marker) root.reject("marker", "nothing", fmt::format("a table [marker], {}", needed_by));
  if (!experiment.calibration && !experiment.scale) {
    root.reject("calibration", "nothing", fmt::format("a table [calibration] or [scale], {}", needed_by));
  }
  if (experiment.calibration && experiment.calibration->planes.empty() && !root.table("calibration").has("plane") &&
      !stated_by_all_groups(experiment, true, [](const GroupSetup& group) { return !group.planes.empty(); })) {
    root.table("calibration").reject("plane", "nothing", "a string, the view with the pattern in the plane of motion");
  }
}

/// X runs along the pattern's longer row, and the pattern lies along the track.
void check_downhill(const Experiment& experiment, const TomlTable& root, const std::vector<TomlTable>& group_tables) {
  if (!experiment.calibration) return;
  const auto filmed_along_y =
      std::find_if(experiment.clips.begin(), experiment.clips.end(), [&](const ClipSetup& clip) {
        return !clip.file.empty() && is_along_y(downhill_of(experiment, clip.group).value_or(Downhill::plus_x));
      });
  if (filmed_along_y == experiment.clips.end()) return;
  const GroupSetup* group = group_of(experiment, filmed_along_y->group);
  const bool own = group != nullptr && group->downhill;
  const TomlTable table =
      own ? group_tables.at(static_cast<std::size_t>(group - experiment.groups.data())) : root.table("track");
  table.reject(
      "downhill",
      fmt::format("\"{}\" for clip \"{}\", which is calibrated by a pattern", table.text("downhill"),
                  filmed_along_y->name),
      "\"+X\" or \"-X\", along the pattern's longer row (\"+Y\" and \"-Y\" need [scale], or a Tracker project)");
}

/// Of tables of frames and pixels in this folder.
ImageUnits image_units_of(const Experiment& experiment) {
  ImageUnits units;
  if (experiment.camera) units.frame_rate_hz = experiment.camera->frame_rate_hz;
  if (!experiment.scale) return units;
  units.px_per_m = experiment.scale->px_per_m;
  units.px_per_m_sd = experiment.scale->px_per_m_sd;
  return units;
}

/// The most common mistake of a new user: no folder, a wrong one, or a file inside it.
void check_folder(const fs::path& path) {
  const std::string wanted = "a folder with an experiment.toml (glidelab new FOLDER makes one that explains every key)";
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    throw base::InputError(base::Issue{path.string(), 0, "", found, expected});
  };
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (status.type() == fs::file_type::none) refuse(failure.message(), wanted);
  if (!fs::exists(status)) refuse("no file or folder of this name", wanted);
  if (path.filename() == "experiment.toml") {
    refuse("a file",
           fmt::format("the folder that it is in, {}", path.has_parent_path() ? path.parent_path().string() : "."));
  }
  if (!fs::is_directory(status)) refuse("a file", wanted);
  if (!fs::exists(path / "experiment.toml", failure)) refuse("a folder without experiment.toml", wanted);
}

}  // namespace

Experiment read_experiment(const fs::path& path, Permissions permitted) {
  check_folder(path);
  const FolderFiles folder{path, permitted.outside};
  Experiment experiment;
  experiment.folder = path;
  experiment.file = path / "experiment.toml";
  const base::TomlFile file = base::TomlFile::load(experiment.file);
  const TomlTable root = file.root();

  root.integer("format", 1, 1);
  root.ignore("extra");
  experiment.name = root.text("name");
  const std::optional<double> gravity_m_s2 = root.maybe_number("gravity_m_s2", base::above(0.0));
  const std::optional<double> gravity_sd_m_s2 = root.maybe_number("gravity_sd_m_s2", base::at_least(0.0));
  if (gravity_sd_m_s2 && !gravity_m_s2) {
    root.reject("gravity_sd_m_s2", fmt::format("{}", *gravity_sd_m_s2),
                "gravity_m_s2, whose uncertainty it is, as well");
  }
  const Gravity gravity = stated_gravity(gravity_m_s2, gravity_sd_m_s2);
  experiment.gravity_m_s2 = gravity.m_s2;
  experiment.gravity_sd_m_s2 = gravity.sd_m_s2;
  if (const auto table = root.maybe_table("camera")) experiment.camera = read_camera(*table);
  if (experiment.camera) experiment.camera->most_pixels = permitted.most_pixels;
  if (const auto table = root.maybe_table("calibration")) experiment.calibration = read_calibration(*table, folder);
  if (const auto table = root.maybe_table("scale")) experiment.scale = read_scale(*table);
  if (const auto table = root.maybe_table("plumb")) experiment.plumb = read_plumb(*table, folder);
  if (const auto table = root.maybe_table("marker")) experiment.marker = read_marker(*table);
  if (root.has("lines")) experiment.lines = folder.file(root, "lines");

  const std::vector<TomlTable> clip_tables =
      experiment.lines || root.has("lines") ? root.tables_or_none("clip") : root.tables("clip");
  for (const TomlTable& table : clip_tables) experiment.clips.push_back(read_clip(table, folder));
  const RecordedBy recorder = read_recorder(root);
  for (ClipSetup& clip : experiment.clips) {
    clip.recorded_by = recorder;
    clip.image_units = image_units_of(experiment);
    if (clip.file.empty() || recorder != RecordedBy::sensor) continue;
    root.reject("recorded_by", fmt::format("\"sensor\" with clip \"{}\", which has images", clip.name),
                "nothing, or \"camera\": it says what measured the positions of a track");
    break;
  }
  if (experiment.lines && !clip_tables.empty()) {
    root.reject("lines", "a table of lines and [[clip]]", "either lines or clips");
  }
  name_groups(experiment.clips);
  const std::vector<TomlTable> group_tables = root.tables_or_none("group");
  for (const TomlTable& table : group_tables) experiment.groups.push_back(read_group(table, folder));
  check_names(experiment.clips, clip_tables, experiment.groups, group_tables);
  check_readings(experiment.clips, clip_tables);

  // A group may have its own downhill; [track] is needed if a group with images has none. A file of positions defines
  // its own direction.
  const auto track = root.maybe_table("track");
  if (track) experiment.track.length_m = track->maybe_number("length_m", base::above(0.0));
  if (track && track->has("downhill")) {
    experiment.track.downhill = read_downhill(*track);
  } else if (!stated_by_all_groups(experiment, true,
                                   [](const GroupSetup& group) { return group.downhill.has_value(); })) {
    if (track) {
      read_downhill(*track);
    } else {
      root.table("track");
    }
  }
  check_sections(experiment, root);
  check_downhill(experiment, root, group_tables);
  file.finish();
  return experiment;
}

std::size_t most_pixels_of(const Experiment& experiment) {
  return experiment.camera ? experiment.camera->most_pixels : kMostPixels;
}

const GroupSetup* group_of(const Experiment& experiment, const std::string& name) {
  const auto found = std::find_if(experiment.groups.begin(), experiment.groups.end(),
                                  [&](const GroupSetup& group) { return group.name == name; });
  return found == experiment.groups.end() ? nullptr : &*found;
}

std::optional<Downhill> downhill_of(const Experiment& experiment, const std::string& group) {
  const GroupSetup* own = group_of(experiment, group);
  return own != nullptr && own->downhill ? own->downhill : experiment.track.downhill;
}

MarkerSetup marker_in(const Experiment& experiment, const ClipSetup& clip) {
  MarkerSetup marker = experiment.marker.value();
  if (clip.start_px) marker.start_px = clip.start_px;
  return marker;
}

void require_clips(const Experiment& experiment) {
  if (!experiment.clips.empty()) return;
  if (experiment.lines) {
    throw base::InputError(base::Issue{experiment.file.string(), 0, "lines", "a table of lines",
                                       "clips or tracks here; glidelab diagnose takes such a table"});
  }
  throw base::InputError(base::Issue{experiment.file.string(), 0, "clip", "none", "one or more clips or tracks"});
}

}  // namespace glidelab::core
