/// [calibration], [marker], [track], [scene] and [plumb]: the scene in front of the camera. Ideal frames show the same
/// scene.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/math/angles.h"
#include "render/scenario/scenario_sections.h"

namespace glidelab::render {
namespace {

using base::kRadPerDegree;
using base::TomlTable;

void read_calibration(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  PatternSetup& pattern = scenario.pattern;
  if (const auto corners = table->maybe_numbers("inner_corners", 2, base::between(3.0, 100.0))) {
    const double columns = (*corners)[0], rows = (*corners)[1];
    if (columns == std::floor(columns) && rows == std::floor(rows) && columns >= rows) {
      pattern.inner_columns = static_cast<int>(columns);
      pattern.inner_rows = static_cast<int>(rows);
    } else if (std::isfinite(columns)) {  // otherwise it is already an error
      table->reject("inner_corners", fmt::format("[{}, {}]", (*corners)[0], (*corners)[1]),
                    "two whole numbers, the larger one first");
    }
  }
  pattern.square_m = table->number_or("square_m", pattern.square_m, {1e-4, 10.0, false, false});
  pattern.views = static_cast<int>(table->integer_or("views", pattern.views, 3, 99));
  if (const auto places = table->maybe_numbers("plane_x_m", 0, base::between(-1000.0, 1000.0))) {
    pattern.plane_x_m = *places;
    if (places->empty() || places->size() > 99) {
      table->reject("plane_x_m", fmt::format("an array of {}", places->size()), "1 to 99 places");
    }
  }
  pattern.plane_y_m = table->number_or("plane_y_m", pattern.plane_y_m, base::between(-1000.0, 1000.0));
  pattern.plane_rotation_rad =
      table->number_or("plane_rotation_deg", pattern.plane_rotation_rad / kRadPerDegree, base::between(-10.0, 10.0)) *
      kRadPerDegree;
}

void read_marker(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  MarkerSetup& marker = scenario.marker;
  marker.diameter_m = table->number_or("diameter_m", marker.diameter_m, {1e-4, 1.0, false, false});
  marker.height_m = table->number_or("height_m", marker.height_m, base::between(-0.2, 0.2));
  marker.reflectance = table->number_or("reflectance", marker.reflectance, base::between(0.0, 20.0));
}

void read_track(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  scenario.track.downhill = table->word("downhill", {"+X", "-X"}, "+X") == "+X" ? 1 : -1;
  scenario.track.length_m = table->number_or("length_m", scenario.track.length_m, {0.1, 100.0, false, false});
}

void read_scene(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  const base::Range albedo = base::between(0.0, 1.0);
  SceneSetup& scene = scenario.scene;
  scene.wall_albedo = table->number_or("wall_albedo", scene.wall_albedo, albedo);
  scene.wall_distance_m = table->number_or("wall_distance_m", scene.wall_distance_m, base::between(0.25, 100.0));
  scene.track_albedo = table->number_or("track_albedo", scene.track_albedo, albedo);
  scene.glider_albedo = table->number_or("glider_albedo", scene.glider_albedo, albedo);
  scene.glider_mass_kg = table->number_or("glider_mass_kg", scene.glider_mass_kg, base::at_least(0.0));
  scene.light_falloff = table->number_or("light_falloff", scene.light_falloff, base::between(0.0, 10.0));
}

void read_plumb(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  PlumbSetup plumb;
  plumb.x_m = table->number_or("x_m", plumb.x_m, base::between(-1000.0, 1000.0));
  plumb.z_m = table->number_or("z_m", plumb.z_m, base::between(-10.0, 10.0));
  plumb.diameter_m = table->number_or("diameter_m", plumb.diameter_m, {1e-5, 0.1, false, false});
  scenario.plumb = plumb;
}

}  // namespace

const ScenarioSection sections::calibration = {.name = "calibration",
                                               .help = "the chessboard and its views",
                                               .in_camera_file = false,
                                               .read = read_calibration,
                                               .settle = nullptr,
                                               .truth = nullptr,
                                               .ideal = sections::keep};

const ScenarioSection sections::marker = {.name = "marker",
                                          .help = "the marker on the glider",
                                          .in_camera_file = false,
                                          .read = read_marker,
                                          .settle = nullptr,
                                          .truth = nullptr,
                                          .ideal = sections::keep};

const ScenarioSection sections::track = {.name = "track",
                                         .help = "in which direction the track falls, and its length",
                                         .in_camera_file = false,
                                         .read = read_track,
                                         .settle = nullptr,
                                         .truth = nullptr,
                                         .ideal = sections::keep};

const ScenarioSection sections::scene = {.name = "scene",
                                         .help = "wall, light and the brightness of things",
                                         .in_camera_file = false,
                                         .read = read_scene,
                                         .settle = nullptr,
                                         .truth = nullptr,
                                         .ideal = sections::keep};

const ScenarioSection sections::plumb = {.name = "plumb",
                                         .help = "the plumb line in the image",
                                         .in_camera_file = false,
                                         .read = read_plumb,
                                         .settle = nullptr,
                                         .truth = nullptr,
                                         .ideal = sections::keep};

}  // namespace glidelab::render
