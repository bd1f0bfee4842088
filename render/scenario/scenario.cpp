#include "render/scenario/scenario.h"

#include <fmt/format.h>

#include <limits>
#include <vector>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "base/toml/strict_toml.h"
#include "render/scenario/camera_catalogue.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario_sections.h"
#include "render/scenario/scene.h"

namespace glidelab::render {
namespace {

using base::TomlTable;

/// The checks that need the whole scenario; asked only of one without other errors.
void check_pictures(const TomlTable& root, const Scenario& scenario) {
  const Camera& camera = scenario.camera;
  if (const auto why = why_not_one_to_one(camera)) {
    root.reject("camera", *why, "a lens that maps one to one over the image");
    return;
  }
  for (std::size_t view = 0; view < scenario.pattern.plane_x_m.size(); ++view) {
    for (const Eigen::Vector3d& corner : outline_of(plane_board(scenario, view))) {
      const auto pixel = project(camera, corner);
      if (pixel && in_picture(camera, *pixel)) continue;
      root.reject("calibration",
                  fmt::format("a pattern of which a part is not in the image, at plane_x_m = {}",
                              scenario.pattern.plane_x_m[view]),
                  "a pattern in the plane of motion that is wholly in the image, with a white border of one square");
      break;
    }
  }
  if (scenario.plumb && !plumb_region(scenario)) {
    root.reject("plumb", fmt::format("a plumb line at x = {} m", scenario.plumb->x_m), "one that the camera sees");
  }
  constexpr double kNearest = 0.1;  // m before the camera
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
        seen = seen || (pixel && in_picture(camera, *pixel));
      }
      const std::string clip = fmt::format("clip \"{}\"", motion.name);
      if (behind) {
        root.reject("configuration", clip + " with a marker that gets behind the camera", "a motion before the camera");
      } else if (!seen) {
        root.reject("configuration", clip + " with a marker that is never in the image",
                    "a motion of which the camera sees at least a part");
      }
    }
  }
}

/// A file of the other sort is said to be one, not taken apart key by key. It is read apart: asking for a key makes it
/// a known one.
void refuse_sweep(std::string_view text, const std::filesystem::path& path) {
  const base::TomlFile file = base::TomlFile::parse(text, path.string());
  if (file.root().has("configuration") || !file.root().has("scenario") || !file.root().has("vary")) return;
  throw base::InputError(base::Issue{path.string(), 0, "", "a sweep", "a scenario; sweep and require take a sweep"});
}

}  // namespace

Scenario read_scenario(const std::filesystem::path& path) {
  std::error_code ignored;  // what cannot be looked at says so when it is read
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
  if (checks == ScenarioChecks::all) check_pictures(root, scenario);
  file.finish();
  return scenario;
}

}  // namespace glidelab::render
