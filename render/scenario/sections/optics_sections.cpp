/// [vignetting], [focus], [light] and [mount]: the effects of optics, lamps and tripod on the image.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/math/angles.h"
#include "render/scenario/scenario_sections.h"

namespace glidelab::render {
namespace {

using base::kRadPerDegree;
using base::TomlTable;

void read_vignetting(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  const Camera& camera = scenario.camera;
  Vignetting& vignetting = scenario.vignetting;
  vignetting.cos4 = table->boolean_or("cos4", false);
  const auto radii = table->maybe_numbers("radius_px", 0, base::between(0.0, 1e5));
  const auto gains = table->maybe_numbers("gain", 0, base::between(0.0, 10.0));
  if (!radii && !gains) return;
  if (!radii || !gains || radii->size() != gains->size()) {
    table->reject("gain", fmt::format("{} gains", gains ? gains->size() : 0),
                  fmt::format("one for each radius_px, {}", radii ? radii->size() : 0));
    return;
  }
  for (std::size_t i = 0; i < radii->size(); ++i) {
    if (i == 0 ? (*radii)[0] != 0.0 : !((*radii)[i] > (*radii)[i - 1])) {
      table->reject("radius_px", fmt::format("{}", (*radii)[i]), "radii that rise, from 0 on");
      return;
    }
    vignetting.radial.emplace_back((*radii)[i], (*gains)[i]);
  }
  if (radii->empty() || radii->back() < farthest_radius_px(camera)) {
    table->reject("radius_px", fmt::format("a table up to {} px", radii->empty() ? 0.0 : radii->back()),
                  fmt::format("one to the farthest corner, {:.6g} px", farthest_radius_px(camera)));
  }
}

void vignetting_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  if (!scenario.vignetting.none()) {
    nlohmann::ordered_json radial = nlohmann::ordered_json::array();
    for (const Eigen::Vector2d& entry : scenario.vignetting.radial) radial.push_back({entry.x(), entry.y()});
    camera["vignetting"] = {{"cos4", scenario.vignetting.cos4}, {"radial", radial}};
  }
}

void no_vignetting(Scenario& scenario) {
  scenario.vignetting = {};
}

void read_focus(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  Focus read;
  read.f_number = table->number("f_number", base::between(0.5, 1000.0));
  read.focus_distance_m = table->number("focus_distance_m", base::between(0.01, 1e6));
  read.pixel_pitch_m = table->number("pixel_pitch_m", base::between(1e-7, 1e-3));
  read.wavelength_m = table->number_or("wavelength_m", read.wavelength_m, base::between(1e-7, 2e-5));
  read.core_px = table->number_or("core_px", read.core_px, base::between(0.0, 20.0));
  scenario.focus = read;
}

void focus_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  if (scenario.focus) {
    const Focus& focus = *scenario.focus;
    const double depth_m = scenario.camera.X_WC.translation().norm();
    camera["focus"] = {{"f_number", focus.f_number},
                       {"focus_distance_m", focus.focus_distance_m},
                       {"pixel_pitch_m", focus.pixel_pitch_m},
                       {"wavelength_m", focus.wavelength_m},
                       {"core_px", focus.core_px},
                       {"core_sigma_px", core_sigma_px(focus, scenario.camera)},
                       {"disc_radius_px_at_reference", disc_radius_px(focus, scenario.camera, depth_m)}};
  }
}

void all_in_focus(Scenario& scenario) {
  scenario.focus.reset();
}

void read_light(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  Light& light = scenario.light;
  light.level = table->number_or("level", light.level, {0.0, 1000.0, true, false});
  if (const auto gradient = table->maybe_numbers("gradient_per_m", 2, base::between(-2.0, 2.0))) {
    light.gradient_per_m = {(*gradient)[0], (*gradient)[1]};
  }
  light.flicker_depth = table->number_or("flicker_depth", 0.0, base::between(0.0, 1.0));
  light.flicker_hz = table->number_or("flicker_hz", light.flicker_hz, {0.0, 1e6, true, false});
  light.flicker_phase_rad = table->number_or("flicker_phase_deg", 0.0, base::between(-360.0, 360.0)) * kRadPerDegree;
  light.ring_light = table->number_or("ring_light", 0.0, base::between(0.0, 1000.0));
  for (const TomlTable& one : table->tables_or_none("reflection")) {
    Reflection reflection;
    reflection.position_W = sections::vector_or(one, "position_m", reflection.position_W);
    reflection.radius_m = one.number_or("radius_m", reflection.radius_m, {1e-4, 10.0, false, false});
    reflection.radiance = one.number_or("radiance", reflection.radiance, base::between(0.0, 1000.0));
    reflection.velocity_m_s = sections::vector_or(one, "velocity_m_s", reflection.velocity_m_s);
    reflection.follow = one.number_or("follow", 0.0, base::between(-10.0, 10.0));
    reflection.in_front = one.boolean_or("in_front", false);
    light.reflections.push_back(reflection);
  }
}

void light_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  const Light& light = scenario.light;
  camera["light"] = {{"level", light.level},
                     {"gradient_per_m", {light.gradient_per_m.x(), light.gradient_per_m.y()}},
                     {"flicker_depth", light.flicker_depth},
                     {"flicker_hz", light.flicker_hz},
                     {"ring_light", light.ring_light},
                     {"reflections", light.reflections.size()}};
}

void even_light(Scenario& scenario) {
  scenario.light = {};
}

void read_mount(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  Mount& mount = scenario.mount;
  mount.focal_change = table->number_or("focal_change", 0.0, base::between(-0.2, 0.2));
  const std::vector<std::string> axes = {"x", "y", "z", "pan", "tilt", "roll"};
  for (const TomlTable& one : table->tables_or_none("motion")) {
    MountMotion motion;
    const std::optional<std::string> axis = one.one_of("axis", axes);
    if (!axis) continue;
    const auto number = std::find(axes.begin(), axes.end(), *axis) - axes.begin();
    motion.axis = static_cast<MountAxis>(number);
    const bool turns = number >= 3;
    const double unit = turns ? kRadPerDegree : 1.0;
    const base::Range range = turns ? base::between(-30.0, 30.0) : base::between(-1.0, 1.0);
    motion.offset = unit * one.number_or(turns ? "offset_deg" : "offset_m", 0.0, range);
    motion.drift_per_s = unit * one.number_or(turns ? "drift_deg_s" : "drift_m_s", 0.0, range);
    motion.amplitude = unit * one.number_or(turns ? "amplitude_deg" : "amplitude_m", 0.0, range);
    motion.frequency_hz = one.number_or("frequency_hz", 0.0, base::between(0.0, 1e5));
    motion.phase_rad = one.number_or("phase_deg", 0.0, base::between(-360.0, 360.0)) * kRadPerDegree;
    if (motion.amplitude != 0.0 && motion.frequency_hz == 0.0) {
      one.reject("frequency_hz", "nothing, or 0", "the frequency of an amplitude");
    }
    mount.motions.push_back(motion);
  }
}

void mount_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  camera["mount"] = {{"focal_change", scenario.mount.focal_change}, {"motions", scenario.mount.motions.size()}};
}

void mount_at_rest(Scenario& scenario) {
  scenario.mount = {};
}

}  // namespace

const ScenarioSection sections::vignetting = {.name = "vignetting",
                                              .help = "how the image gets darker towards its corners",
                                              .in_camera_file = true,
                                              .read = read_vignetting,
                                              .settle = nullptr,
                                              .truth = vignetting_truth,
                                              .ideal = no_vignetting};

const ScenarioSection sections::focus = {.name = "focus",
                                         .help = "depth of field and blur of the lens",
                                         .in_camera_file = true,
                                         .read = read_focus,
                                         .settle = nullptr,
                                         .truth = focus_truth,
                                         .ideal = all_in_focus};

const ScenarioSection sections::light = {.name = "light",
                                         .help = "level, gradient and flicker of the light, and reflections",
                                         .in_camera_file = false,
                                         .read = read_light,
                                         .settle = nullptr,
                                         .truth = light_truth,
                                         .ideal = even_light};

const ScenarioSection sections::mount = {
    .name = "mount",
    .help = "how the camera moves on its mount, and its focus after the calibration",
    .in_camera_file = false,
    .read = read_mount,
    .settle = nullptr,
    .truth = mount_truth,
    .ideal = mount_at_rest};

}  // namespace glidelab::render
