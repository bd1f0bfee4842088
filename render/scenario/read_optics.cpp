#include "render/scenario/read_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace glidelab::render {
namespace {

using base::TomlTable;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

Eigen::Vector3d vector_or(const TomlTable& table, std::string_view key, const Eigen::Vector3d& otherwise) {
  const auto values = table.maybe_numbers(key, 3, base::between(-1000.0, 1000.0));
  return values ? Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]) : otherwise;
}

void read_lens(const TomlTable& camera, Lens& lens) {
  const std::string model = camera.word("lens", {"brown-conrady", "rational", "fisheye"}, "brown-conrady");
  lens.model = model == "rational"  ? LensModel::rational
               : model == "fisheye" ? LensModel::fisheye
                                    : LensModel::brown_conrady;
  const std::optional<TomlTable> found = camera.maybe_table("distortion");
  if (!found) return;
  const auto number = [&](const char* key, double largest) {
    return found->number_or(key, 0.0, base::between(-largest, largest));
  };
  // A quotient's coefficients may be large on both sides.
  const double factor = lens.model == LensModel::rational ? 100.0 : 1.0;
  lens.k1 = number("k1", 10.0 * factor);
  lens.k2 = number("k2", 100.0 * factor);
  lens.k3 = number("k3", 1000.0 * factor);
  if (lens.model != LensModel::brown_conrady) lens.k4 = number("k4", 1000.0);
  if (lens.model == LensModel::rational) {
    lens.k5 = number("k5", 10000.0);
    lens.k6 = number("k6", 100000.0);
  }
  if (lens.model != LensModel::fisheye) {
    lens.p1 = number("p1", 1.0);
    lens.p2 = number("p2", 1.0);
  }
}

struct Pose {
  Eigen::Vector3d position = {0.0, 0.1, 2.4};
  Eigen::Vector3d target = {0.0, 0.0, 0.0};
  double roll_rad = 0.0;
};

void read_camera(const TomlTable& root, Scenario& scenario) {
  Camera& camera = scenario.camera;
  camera.width_px = 800;
  camera.height_px = 600;
  camera.focal_px = {1200.0, 1200.0};
  Recording& recording = scenario.recording;
  Pose pose;
  std::optional<std::vector<double>> center;
  if (const std::optional<TomlTable> found = root.maybe_table("camera")) {
    const TomlTable& table = *found;
    camera.width_px = static_cast<int>(table.integer_or("width_px", camera.width_px, 64, 8192));
    camera.height_px = static_cast<int>(table.integer_or("height_px", camera.height_px, 64, 8192));
    recording.frame_rate_hz = table.number_or("frame_rate_hz", recording.frame_rate_hz, {1e-3, 1e5, false, false});
    recording.exposure_s =
        table.number_or("exposure_s", std::min(recording.exposure_s, 1.0 / recording.frame_rate_hz), base::above(0.0));
    if (recording.exposure_s > longest_exposure_s(recording.frame_rate_hz)) {
      table.reject("exposure_s", fmt::format("{}", recording.exposure_s),
                   fmt::format("at most the frame time, {} s", 1.0 / recording.frame_rate_hz));
    }
    if (const auto focal = table.maybe_numbers("focal_px", 2, {1.0, 1e6, false, false})) {
      camera.focal_px = {(*focal)[0], (*focal)[1]};
    }
    center = table.maybe_numbers("center_px", 2, base::between(-1e5, 1e5));
    pose.position = vector_or(table, "position_m", pose.position);
    pose.target = vector_or(table, "target_m", pose.target);
    pose.roll_rad = table.number_or("roll_deg", 0.0, base::between(-180.0, 180.0)) * kRadPerDeg;
    read_lens(table, camera.lens);
    if (!(pose.position.z() > 0.05)) {
      table.reject("position_m", fmt::format("z = {}", pose.position.z()),
                   "a camera before the plane of motion, z above 0.05");
    } else if (!(pose.target.z() < pose.position.z() - 0.05)) {
      table.reject("target_m", fmt::format("z = {}", pose.target.z()),
                   "a point that is farther from the camera's side");
    }
  }
  camera.center_px = center ? Eigen::Vector2d((*center)[0], (*center)[1])
                            : Eigen::Vector2d(0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1));
  camera.X_WC = look_at(pose.position, pose.target, pose.roll_rad);
}

void read_shutter(const TomlTable& root, const Camera& camera, Recording& recording) {
  Shutter& shutter = recording.shutter;
  shutter.rows = camera.height_px;
  const std::optional<TomlTable> table = root.maybe_table("shutter");
  if (!table) return;
  shutter.rolling = table->word("kind", {"global", "rolling"}) == "rolling";
  shutter.bottom_first = table->word("first_row", {"top", "bottom"}, "top") == "bottom";
  if (!shutter.rolling) {
    for (const char* key : {"line_readout_s", "first_row"}) {
      if (table->has(key)) table->reject(key, "one with a global shutter", "kind = \"rolling\"");
    }
    return;
  }
  shutter.line_readout_s = table->number("line_readout_s", base::above(0.0));
  const double frame_s = 1.0 / recording.frame_rate_hz;
  if (shutter.line_readout_s * camera.height_px > frame_s * (1.0 + 1e-9)) {
    table->reject("line_readout_s",
                  fmt::format("{} s, with {} rows {:.6g} s", shutter.line_readout_s, camera.height_px,
                              shutter.line_readout_s * camera.height_px),
                  fmt::format("rows that are read within the frame time, {:.6g} s", frame_s));
  }
}

void read_vignetting(const TomlTable& root, const Camera& camera, Vignetting& vignetting) {
  const std::optional<TomlTable> table = root.maybe_table("vignetting");
  if (!table) return;
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

void read_focus(const TomlTable& root, std::optional<Focus>& focus) {
  const std::optional<TomlTable> table = root.maybe_table("focus");
  if (!table) return;
  Focus read;
  read.f_number = table->number("f_number", base::between(0.5, 1000.0));
  read.focus_distance_m = table->number("focus_distance_m", base::between(0.01, 1e6));
  read.pixel_pitch_m = table->number("pixel_pitch_m", base::between(1e-7, 1e-3));
  read.wavelength_m = table->number_or("wavelength_m", read.wavelength_m, base::between(1e-7, 2e-5));
  read.core_px = table->number_or("core_px", read.core_px, base::between(0.0, 20.0));
  focus = read;
}

void read_light(const TomlTable& root, Light& light) {
  const std::optional<TomlTable> table = root.maybe_table("light");
  if (!table) return;
  light.level = table->number_or("level", light.level, {0.0, 1000.0, true, false});
  if (const auto gradient = table->maybe_numbers("gradient_per_m", 2, base::between(-2.0, 2.0))) {
    light.gradient_per_m = {(*gradient)[0], (*gradient)[1]};
  }
  light.flicker_depth = table->number_or("flicker_depth", 0.0, base::between(0.0, 1.0));
  light.flicker_hz = table->number_or("flicker_hz", light.flicker_hz, {0.0, 1e6, true, false});
  light.flicker_phase_rad = table->number_or("flicker_phase_deg", 0.0, base::between(-360.0, 360.0)) * kRadPerDeg;
  light.ring_light = table->number_or("ring_light", 0.0, base::between(0.0, 1000.0));
  for (const TomlTable& one : table->tables_or_none("reflection")) {
    Reflection reflection;
    reflection.position_W = vector_or(one, "position_m", reflection.position_W);
    reflection.radius_m = one.number_or("radius_m", reflection.radius_m, {1e-4, 10.0, false, false});
    reflection.radiance = one.number_or("radiance", reflection.radiance, base::between(0.0, 1000.0));
    reflection.velocity_m_s = vector_or(one, "velocity_m_s", reflection.velocity_m_s);
    reflection.follow = one.number_or("follow", 0.0, base::between(-10.0, 10.0));
    reflection.in_front = one.boolean_or("in_front", false);
    light.reflections.push_back(reflection);
  }
}

void read_mount(const TomlTable& root, Mount& mount) {
  const std::optional<TomlTable> table = root.maybe_table("mount");
  if (!table) return;
  mount.focal_change = table->number_or("focal_change", 0.0, base::between(-0.2, 0.2));
  const std::vector<std::string> axes = {"x", "y", "z", "pan", "tilt", "roll"};
  for (const TomlTable& one : table->tables_or_none("motion")) {
    MountMotion motion;
    const std::optional<std::string> axis = one.one_of("axis", axes);
    if (!axis) continue;
    const auto number = std::find(axes.begin(), axes.end(), *axis) - axes.begin();
    motion.axis = static_cast<MountAxis>(number);
    const bool turns = number >= 3;
    const double unit = turns ? kRadPerDeg : 1.0;
    const base::Range range = turns ? base::between(-30.0, 30.0) : base::between(-1.0, 1.0);
    motion.offset = unit * one.number_or(turns ? "offset_deg" : "offset_m", 0.0, range);
    motion.drift_per_s = unit * one.number_or(turns ? "drift_deg_s" : "drift_m_s", 0.0, range);
    motion.amplitude = unit * one.number_or(turns ? "amplitude_deg" : "amplitude_m", 0.0, range);
    motion.frequency_hz = one.number_or("frequency_hz", 0.0, base::between(0.0, 1e5));
    motion.phase_rad = one.number_or("phase_deg", 0.0, base::between(-360.0, 360.0)) * kRadPerDeg;
    if (motion.amplitude != 0.0 && motion.frequency_hz == 0.0) {
      one.reject("frequency_hz", "nothing, or 0", "the frequency of an amplitude");
    }
    mount.motions.push_back(motion);
  }
}

}  // namespace

void read_optics(const TomlTable& root, Scenario& scenario) {
  read_camera(root, scenario);
  read_shutter(root, scenario.camera, scenario.recording);
  read_vignetting(root, scenario.camera, scenario.vignetting);
  read_focus(root, scenario.focus);
  read_light(root, scenario.light);
  read_mount(root, scenario.mount);
}

}  // namespace glidelab::render
