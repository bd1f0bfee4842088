#include "render/scenario/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/toml/strict_toml.h"
#include "base/toml/toml_set.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario_sections.h"
#include "render/scenario/scene.h"

namespace glidelab::render {
namespace {

using base::TomlFile;
using base::TomlTable;

/// The sections that a camera's file may have.
std::vector<std::string_view> camera_file_sections() {
  std::vector<std::string_view> names;
  for (const ScenarioSection* section : scenario_sections()) {
    if (section->in_camera_file) names.push_back(section->name);
  }
  return names;
}

/// If the scenario has this key, these keys of the camera do not apply.
struct Choice {
  std::string_view section;
  std::string_view key;
  std::vector<std::string> belonging;
};

const std::vector<Choice>& choices() {
  static const std::vector<Choice> all = {
      {"codec", "name", {"container", "quality", "crf", "bitrate_kbit_s", "gop"}},
      {"codec", "crf", {"bitrate_kbit_s"}},
      {"codec", "bitrate_kbit_s", {"crf"}},
      {"shutter", "kind", {"line_readout_s", "first_row"}},
      {"camera", "lens", {"distortion"}},
      {"sensor", "tone", {"gamma", "tone_from", "tone_to"}},
      {"sensor", "white_level", {"white_photons_s"}},
      {"sensor", "white_photons_s", {"white_level"}},
      {"clock", "variable", {"stamp_tick_s"}},
  };
  return all;
}

std::vector<std::string> left_out(const TomlTable& own, std::string_view section) {
  std::vector<std::string> keys;
  for (const Choice& choice : choices()) {
    if (choice.section != section || !own.has(choice.key)) continue;
    keys.insert(keys.end(), choice.belonging.begin(), choice.belonging.end());
  }
  return keys;
}

void check_source(const TomlTable& values, const TomlTable& sources, const std::string& key) {
  const std::vector<std::string> found = sources.texts_or_none(key);
  const std::vector<std::string> kinds = {"measured", "data sheet", "derived", "assumed"};
  const bool known = !found.empty() && std::find(kinds.begin(), kinds.end(), found.front()) != kinds.end();
  if (found.size() == 2 && known && !found[1].empty()) return;
  const TomlTable& where = sources.has(key) ? sources : values;
  where.reject(key, sources.has(key) ? "another source" : "a value without a source",
               "[kind, where from] in [source…], kind being measured, data sheet, derived or assumed");
}

void check_sources(const TomlTable& root) {
  const std::optional<TomlTable> source = root.maybe_table("source");
  if (!source) return;
  for (const std::string_view section : camera_file_sections()) {
    const std::optional<TomlTable> values = root.maybe_table(section);
    if (!values) continue;
    const TomlTable sources = source->table(section);
    for (const std::string& key : values->keys()) {
      values->ignore(key);
      check_source(*values, sources, key);
    }
  }
}

}  // namespace

CameraFile read_camera_name(const std::filesystem::path& path) {
  TomlFile file = TomlFile::load(path);
  const TomlTable root = file.root();
  root.integer_or("format", 1, 1, 1);
  CameraFile camera{root.text_or("name", path.stem().string()), root.text_or("price_class", "unknown")};
  root.ignore("notes");
  for (const std::string_view section : camera_file_sections()) root.ignore(section);
  check_sources(root);
  file.finish();
  return camera;
}

CameraFile take_camera_file(const std::filesystem::path& path, TomlFile& scenario, std::string_view scenario_text) {
  const CameraFile camera = read_camera_name(path);
  // Requesting a key marks it as known, so another copy of both files is queried here.
  TomlFile values = TomlFile::load(path);
  const TomlFile own = TomlFile::parse(scenario_text, scenario.name());
  for (const std::string_view section : camera_file_sections()) {
    const std::optional<TomlTable> table = own.root().maybe_table(section);
    scenario.add_missing(section, values, table ? left_out(*table, section) : std::vector<std::string>{});
  }
  return camera;
}

std::string with_camera_written_in(std::string_view scenario_text, const std::filesystem::path& scenario_file) {
  const TomlFile scenario = TomlFile::parse(scenario_text, scenario_file.string());
  const std::optional<std::string> camera = scenario.root().maybe_text("camera_file");
  if (!camera) return std::string(scenario_text);
  const std::filesystem::path path = scenario_file.parent_path() / *camera;
  read_camera_name(path);  // reports errors of the file
  std::vector<base::TomlSection> sections;
  for (const std::string_view section : camera_file_sections()) {
    const std::optional<TomlTable> table = scenario.root().maybe_table(section);
    sections.push_back({std::string(section), table ? left_out(*table, section) : std::vector<std::string>{}});
  }
  return base::with_missing(scenario_text, scenario_file.string(), base::read_file(path), path.string(), sections,
                            "camera_file");
}

namespace {

using base::TomlTable;

/// The checks that need the whole scenario; made only if there are no other errors.
void check_images(const TomlTable& root, const Scenario& scenario, bool stills) {
  const Camera& camera = scenario.camera;
  if (const auto why = why_not_one_to_one(camera)) {
    root.reject("camera", *why, "a lens that maps one to one over the image");
    return;
  }
  for (std::size_t view = 0; stills && view < scenario.pattern.plane_x_m.size(); ++view) {
    for (const Eigen::Vector3d& corner : outline_of(plane_board(scenario, view))) {
      const auto pixel = project(camera, corner);
      if (pixel && in_image(camera, *pixel)) continue;
      root.reject("calibration",
                  fmt::format("a pattern that is partly outside the image, at plane_x_m = {}",
                              scenario.pattern.plane_x_m[view]),
                  "a pattern in the plane of motion that is wholly in the image, with a white border of one square");
      break;
    }
  }
  if (stills && scenario.plumb && !plumb_region(scenario)) {
    root.reject("plumb", fmt::format("a plumb line at x = {} m", scenario.plumb->x_m), "one that the camera sees");
  }
  constexpr double kNearest = 0.1;  // m in front of the camera
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      bool seen = false;
      bool behind = false;
      // A step of frame time, or a thousandth of a long clip.
      const std::size_t frames = frame_count(scenario.recording, motion);
      std::vector<double> times;
      for (std::size_t i = 0; i < frames; i += 1 + frames / 1000) {
        times.push_back(static_cast<double>(i) / scenario.recording.frame_rate_hz +
                        0.5 * scenario.recording.exposure_s);
      }
      for (const sim::State& state : sim::simulate(configuration.body, motion.x0_m, motion.v0_m_s, times).states) {
        const Eigen::Vector3d marker = marker_position_W(scenario, configuration.body.incline_rad, state.x_m);
        behind = behind || !((camera.X_WC.inverse() * marker).z() > kNearest + scenario.marker.diameter_m);
        const auto pixel = project(camera, marker);
        seen = seen || (pixel && in_image(camera, *pixel));
      }
      const std::string clip = fmt::format("clip \"{}\"", motion.name);
      if (behind) {
        root.reject("configuration", clip + " with a marker that gets behind the camera",
                    "a motion in front of the camera");
      } else if (!seen) {
        root.reject("configuration", clip + " with a marker that is never in the image",
                    "a motion that the camera sees at least in part");
      }
    }
  }
}

/// Work of hours or terabytes is refused before it begins.
void check_length(const TomlTable& root, const Scenario& scenario) {
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      const std::size_t frames = frame_count(scenario.recording, motion);
      if (frames <= kMostFrames) continue;
      const double pixels = static_cast<double>(scenario.camera.width_px) * scenario.camera.height_px;
      root.reject(
          "configuration",
          fmt::format("clip \"{}\" with {} frames ({:.6g} s at {:.6g} Hz; {:.3g} GB of pixels)", motion.name, frames,
                      motion.duration_s, scenario.recording.frame_rate_hz, 1e-9 * pixels * static_cast<double>(frames)),
          fmt::format("at most {} frames in a clip: a lower frame_rate_hz or a shorter duration_s", kMostFrames));
    }
  }
}

/// A file of the other kind is reported as such, not key by key. It is read separately, because requesting a key makes
/// it known.
void refuse_sweep(std::string_view text, const std::filesystem::path& path) {
  const base::TomlFile file = base::TomlFile::parse(text, path.string());
  if (file.root().has("configuration") || !file.root().has("scenario") || !file.root().has("vary")) return;
  throw base::InputError(base::Issue{path.string(), 0, "", "a sweep", "a scenario; sweep and require take a sweep"});
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& path) {
  std::error_code ignored;  // a file that cannot be accessed fails when it is read
  if (std::filesystem::is_directory(path, ignored)) {
    const bool recording = std::filesystem::exists(path / "experiment.toml", ignored);
    throw base::InputError(base::Issue{path.string(), 0, "",
                                       recording ? "a folder with an experiment.toml, a recording" : "a folder",
                                       "a scenario, a file (docs/reference/scenario.md)"});
  }
  return read_scenario(base::read_file(path), path);
}

Scenario read_scenario(std::string_view text, const std::filesystem::path& path, ScenarioChecks checks) {
  base::TomlFile file = base::TomlFile::parse(text, path.string());
  const TomlTable root = file.root();
  refuse_sweep(text, path);
  Scenario scenario;
  if (const auto camera = root.maybe_text("camera_file")) {
    const std::filesystem::path camera_path = path.parent_path() / *camera;
    std::error_code unreadable;
    if (!std::filesystem::is_regular_file(camera_path, unreadable)) {
      throw base::InputError(base::Issue{path.string(), root.line("camera_file"), "camera_file",
                                         fmt::format("no file {}", camera_path.lexically_normal().string()),
                                         "the name of a camera's file, from the scenario's folder"});
    }
    scenario.camera_name = take_camera_file(camera_path, file, text).name;
  }
  scenario.file = path;
  scenario.motion = sim::read_motions(root);
  scenario.seed = static_cast<std::uint64_t>(root.integer_or("seed", 1, 0, std::numeric_limits<long>::max()));
  read_sections(root, scenario);
  file.finish();
  check_length(root, scenario);
  if (checks != ScenarioChecks::values) check_images(root, scenario, checks == ScenarioChecks::all);
  file.finish();
  return scenario;
}

}  // namespace glidelab::render
