#include "render/scenario/scenario.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "base/toml/strict_toml.h"
#include "render/scenario/camera_catalogue.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/read_optics.h"
#include "render/scenario/read_sensor.h"
#include "render/scenario/scene.h"

namespace glidelab::render {
namespace {

using base::TomlTable;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// An optional section: absent, it is as good as empty.
template <typename Read>
void section(const TomlTable& root, std::string_view key, const Read& read) {
  if (const std::optional<TomlTable> table = root.maybe_table(key)) read(*table);
}

void read_pattern(const TomlTable& root, PatternSetup& pattern) {
  section(root, "calibration", [&](const TomlTable& table) {
    if (const auto corners = table.maybe_numbers("inner_corners", 2, base::between(3.0, 100.0))) {
      const double columns = (*corners)[0], rows = (*corners)[1];
      if (columns == std::floor(columns) && rows == std::floor(rows) && columns >= rows) {
        pattern.inner_columns = static_cast<int>(columns);
        pattern.inner_rows = static_cast<int>(rows);
      } else if (std::isfinite(columns)) {  // else it is an error already
        table.reject("inner_corners", fmt::format("[{}, {}]", (*corners)[0], (*corners)[1]),
                     "two whole numbers, the larger one first");
      }
    }
    pattern.square_m = table.number_or("square_m", pattern.square_m, {1e-4, 10.0, false, false});
    pattern.views = static_cast<int>(table.integer_or("views", pattern.views, 3, 99));
    if (const auto places = table.maybe_numbers("plane_x_m", 0, base::between(-1000.0, 1000.0))) {
      pattern.plane_x_m = *places;
      if (places->empty() || places->size() > 99) {
        table.reject("plane_x_m", fmt::format("an array of {}", places->size()), "1 to 99 places");
      }
    }
    pattern.plane_y_m = table.number_or("plane_y_m", pattern.plane_y_m, base::between(-1000.0, 1000.0));
    pattern.plane_rotation_rad =
        table.number_or("plane_rotation_deg", pattern.plane_rotation_rad / kRadPerDeg, base::between(-10.0, 10.0)) *
        kRadPerDeg;
  });
}

void read_laboratory(const TomlTable& root, Scenario& scenario) {
  const base::Range albedo = base::between(0.0, 1.0);
  section(root, "marker", [&](const TomlTable& table) {
    MarkerSetup& marker = scenario.marker;
    marker.diameter_m = table.number_or("diameter_m", marker.diameter_m, {1e-4, 1.0, false, false});
    marker.height_m = table.number_or("height_m", marker.height_m, base::between(-0.2, 0.2));
    marker.reflectance = table.number_or("reflectance", marker.reflectance, base::between(0.0, 20.0));
  });
  section(root, "track", [&](const TomlTable& table) {
    scenario.track.downhill = table.word("downhill", {"+X", "-X"}, "+X") == "+X" ? 1 : -1;
    scenario.track.length_m = table.number_or("length_m", scenario.track.length_m, {0.1, 100.0, false, false});
  });
  section(root, "scene", [&](const TomlTable& table) {
    SceneSetup& scene = scenario.scene;
    scene.wall_albedo = table.number_or("wall_albedo", scene.wall_albedo, albedo);
    scene.wall_distance_m = table.number_or("wall_distance_m", scene.wall_distance_m, base::between(0.25, 100.0));
    scene.track_albedo = table.number_or("track_albedo", scene.track_albedo, albedo);
    scene.glider_albedo = table.number_or("glider_albedo", scene.glider_albedo, albedo);
    scene.glider_mass_kg = table.number_or("glider_mass_kg", scene.glider_mass_kg, base::at_least(0.0));
    scene.light_falloff = table.number_or("light_falloff", scene.light_falloff, base::between(0.0, 10.0));
  });
  section(root, "plumb", [&](const TomlTable& table) {
    PlumbSetup plumb;
    plumb.x_m = table.number_or("x_m", plumb.x_m, base::between(-1000.0, 1000.0));
    plumb.z_m = table.number_or("z_m", plumb.z_m, base::between(-10.0, 10.0));
    plumb.diameter_m = table.number_or("diameter_m", plumb.diameter_m, {1e-5, 0.1, false, false});
    scenario.plumb = plumb;
  });
}

/// The checks that need the whole scenario; asked only of one without other errors.
void check_pictures(const TomlTable& root, const Scenario& scenario) {
  const Camera& camera = scenario.camera;
  if (const auto why = why_not_one_to_one(camera)) {
    root.reject("camera", *why, "a lens that maps one to one over the picture");
    return;
  }
  for (std::size_t view = 0; view < scenario.pattern.plane_x_m.size(); ++view) {
    for (const Eigen::Vector3d& corner : outline_of(plane_board(scenario, view))) {
      const auto pixel = project(camera, corner);
      if (pixel && in_picture(camera, *pixel)) continue;
      root.reject("calibration",
                  fmt::format("a pattern of which a part is not in the picture, at plane_x_m = {}",
                              scenario.pattern.plane_x_m[view]),
                  "a pattern in the plane of motion that is wholly in the picture, with a white border of one square");
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
        root.reject("configuration", clip + " with a marker that is never in the picture",
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
  read_optics(root, scenario);
  read_sensor(root, scenario);
  read_codec(root, scenario);
  read_clock(root, scenario);
  read_pattern(root, scenario.pattern);
  read_laboratory(root, scenario);
  file.finish();
  if (checks == ScenarioChecks::all) check_pictures(root, scenario);
  file.finish();
  return scenario;
}

}  // namespace glidelab::render
