#include "render/read_optics.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

namespace glidelab::render {
namespace {

using base::TomlTable;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

Eigen::Vector3d vector_or(const TomlTable& table, std::string_view key, const Eigen::Vector3d& otherwise) {
  const auto values = table.maybe_numbers(key, 3, base::between(-1000.0, 1000.0));
  return values ? Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]) : otherwise;
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
    if (recording.exposure_s > 1.0 / recording.frame_rate_hz * (1.0 + 1e-9)) {
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
    if (const std::optional<TomlTable> distortion = table.maybe_table("distortion")) {
      const TomlTable& lens = *distortion;
      camera.lens.k1 = lens.number_or("k1", 0.0, base::between(-10.0, 10.0));
      camera.lens.k2 = lens.number_or("k2", 0.0, base::between(-100.0, 100.0));
      camera.lens.k3 = lens.number_or("k3", 0.0, base::between(-1000.0, 1000.0));
      camera.lens.p1 = lens.number_or("p1", 0.0, base::between(-1.0, 1.0));
      camera.lens.p2 = lens.number_or("p2", 0.0, base::between(-1.0, 1.0));
    }
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

}  // namespace

void read_optics(const TomlTable& root, Scenario& scenario) {
  read_camera(root, scenario);
  read_shutter(root, scenario.camera, scenario.recording);
}

}  // namespace glidelab::render
