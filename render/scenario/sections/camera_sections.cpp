/// [camera], [clock] and [shutter]: how the camera sees, and when.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/math/angles.h"
#include "render/scenario/scenario_sections.h"

namespace glidelab::render {
namespace {

using base::kRadPerDegree;
using base::TomlTable;

/// The frame time, plus a billionth for the rounding of a rate's and a time's decimals.
double longest_exposure_s(double frame_rate_hz) {
  return (1.0 + 1e-9) / frame_rate_hz;
}

/// Largest number of pixels of an image. The scene is drawn from a table of all pixels' rays, 40 bytes each in addition
/// to its copy in OpenGL, and Mesa accepts textures of up to 1 GiB.
constexpr long kMostPixels = 8192L * 4096L;

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

void read_camera(const std::optional<TomlTable>& found, Scenario& scenario) {
  Camera& camera = scenario.camera;
  camera.width_px = 800;
  camera.height_px = 600;
  camera.focal_px = {1200.0, 1200.0};
  Recording& recording = scenario.recording;
  Pose pose;
  std::optional<std::vector<double>> center;
  if (found) {
    const TomlTable& table = *found;
    camera.width_px = static_cast<int>(table.integer_or("width_px", camera.width_px, 64, 8192));
    camera.height_px = static_cast<int>(table.integer_or("height_px", camera.height_px, 64, 8192));
    if (const long pixels = static_cast<long>(camera.width_px) * camera.height_px; pixels > kMostPixels) {
      table.reject("height_px",
                   fmt::format("{} with width_px = {}, {:.3g} million pixels", camera.height_px, camera.width_px,
                               1e-6 * static_cast<double>(pixels)),
                   fmt::format("at most {:.3g} million pixels, such as 8192 x 4096, which take 3 GB of memory",
                               1e-6 * kMostPixels));
    }
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
    pose.position = sections::vector_or(table, "position_m", pose.position);
    pose.target = sections::vector_or(table, "target_m", pose.target);
    pose.roll_rad = table.number_or("roll_deg", 0.0, base::between(-180.0, 180.0)) * kRadPerDegree;
    read_lens(table, camera.lens);
    if (!(pose.position.z() > 0.05)) {
      table.reject("position_m", fmt::format("z = {}", pose.position.z()),
                   "a camera in front of the plane of motion, z above 0.05");
    } else if (!(pose.target.z() < pose.position.z() - 0.05)) {
      table.reject("target_m", fmt::format("z = {}", pose.target.z()),
                   "a point that is farther from the camera's side");
    }
  }
  camera.center_px = center ? Eigen::Vector2d((*center)[0], (*center)[1])
                            : Eigen::Vector2d(0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1));
  camera.X_WC = look_at(pose.position, pose.target, pose.roll_rad);
}

nlohmann::ordered_json finite(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json distortion_json(const Lens& lens) {
  nlohmann::ordered_json json = {{"k1", lens.k1}, {"k2", lens.k2}, {"k3", lens.k3}};
  if (lens.model != LensModel::brown_conrady) json["k4"] = lens.k4;
  if (lens.model == LensModel::rational) {
    json["k5"] = lens.k5;
    json["k6"] = lens.k6;
  }
  if (lens.model != LensModel::fisheye) {
    json["p1"] = lens.p1;
    json["p2"] = lens.p2;
  }
  return json;
}

void camera_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  const Camera& from = scenario.camera;
  nlohmann::ordered_json rotation = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    rotation.push_back({from.X_WC.linear()(row, 0), from.X_WC.linear()(row, 1), from.X_WC.linear()(row, 2)});
  }
  const Eigen::Vector3d eye = from.X_WC.translation();
  camera["name"] = scenario.camera_name;
  camera["width_px"] = from.width_px;
  camera["height_px"] = from.height_px;
  camera["focal_px"] = {from.focal_px.x(), from.focal_px.y()};
  camera["center_px"] = {from.center_px.x(), from.center_px.y()};
  camera["lens"] = name_of(from.lens.model);
  camera["distortion"] = distortion_json(from.lens);
  camera["one_to_one_radius"] = finite(fold_radius(from.lens));
  camera["rotation_WC"] = rotation;
  camera["position_m"] = {eye.x(), eye.y(), eye.z()};
  camera["frame_rate_hz"] = scenario.recording.frame_rate_hz;
  camera["exposure_s"] = scenario.recording.exposure_s;
}

/// A pinhole without distortion; the pose stays.
void ideal_camera(Scenario& scenario) {
  scenario.camera.lens = {};
}

/// Exposures must not overlap.
void check_overlap(const TomlTable& table, const Recording& recording) {
  const ClockSetup& clock = recording.clock;
  const double rate_hz = recording.frame_rate_hz * (1.0 + 1e-6 * clock.rate_error_ppm);
  const double free_s = longest_exposure_s(rate_hz) - recording.exposure_s - 2.0 * kLargestJitter * clock.jitter_s;
  const bool refused = recording.exposure_s > longest_exposure_s(recording.frame_rate_hz);  // already reported for
                                                                                            // [camera]
  if (free_s < 0.0 && !refused) {
    table.reject(clock.jitter_s > 0.0 ? "jitter_s" : "rate_error_ppm",
                 fmt::format("exposures of {} s every {} s that overlap", recording.exposure_s, 1.0 / rate_hz),
                 "exposures that do not, with a jitter of up to 5.9 standard deviations each");
  }
}

void read_tick(const TomlTable& table, ClockSetup& clock, double frame_rate_hz) {
  if (!table.has("stamp_tick_s")) return;
  clock.stamp_tick_s = table.number("stamp_tick_s", {0.0, 0.5 / frame_rate_hz, true, false});
  if (!clock.variable) table.reject("stamp_tick_s", "a tick", "variable = true as well: only then are there stamps");
}

void read_clock(const std::optional<TomlTable>& table, Scenario& scenario) {
  if (!table) return;
  ClockSetup& clock = scenario.recording.clock;
  clock.rate_error_ppm = table->number_or("rate_error_ppm", 0.0, base::between(-1e5, 1e5));
  clock.jitter_s = table->number_or("jitter_s", 0.0, base::between(0.0, 1.0));
  clock.dropped_fraction = table->number_or("dropped_fraction", 0.0, base::between(0.0, 0.9));
  clock.duplicated_fraction = table->number_or("duplicated_fraction", 0.0, base::between(0.0, 0.9));
  if (clock.dropped_fraction + clock.duplicated_fraction > 0.9) {
    table->reject("duplicated_fraction", fmt::format("{}", clock.duplicated_fraction),
                  "a tenth of the frames or more that are neither dropped nor duplicated");
  }
  clock.variable = table->boolean_or("variable", false);
  read_tick(*table, clock, scenario.recording.frame_rate_hz);
  check_overlap(*table, scenario.recording);
}

void clock_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  const ClockSetup& clock = scenario.recording.clock;
  camera["clock"] = {{"rate_error_ppm", clock.rate_error_ppm},
                     {"jitter_s", clock.jitter_s},
                     {"dropped_fraction", clock.dropped_fraction},
                     {"duplicated_fraction", clock.duplicated_fraction},
                     {"variable", clock.variable}};
}

void ideal_clock(Scenario& scenario) {
  scenario.recording.clock = {};
}

void read_shutter(const std::optional<TomlTable>& table, Scenario& scenario) {
  const Camera& camera = scenario.camera;
  Recording& recording = scenario.recording;
  Shutter& shutter = recording.shutter;
  shutter.rows = camera.height_px;
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

void shutter_truth(const Scenario& scenario, nlohmann::ordered_json& camera) {
  const Shutter& shutter = scenario.recording.shutter;
  camera["shutter"] = {{"kind", shutter.rolling ? "rolling" : "global"},
                       {"line_readout_s", shutter.line_readout_s},
                       {"first_row", shutter.bottom_first ? "bottom" : "top"}};
}

void ideal_shutter(Scenario& scenario) {
  scenario.recording.shutter = {};
  scenario.recording.shutter.rows = scenario.camera.height_px;
}

}  // namespace

const ScenarioSection sections::camera = {.name = "camera",
                                          .help = "size, rate, exposure, lens and pose of the camera",
                                          .in_camera_file = true,
                                          .read = read_camera,
                                          .settle = nullptr,
                                          .truth = camera_truth,
                                          .ideal = ideal_camera};

const ScenarioSection sections::clock = {.name = "clock",
                                         .help = "how the camera keeps its frame times, and which frames it loses",
                                         .in_camera_file = true,
                                         .read = read_clock,
                                         .settle = nullptr,
                                         .truth = clock_truth,
                                         .ideal = ideal_clock};

const ScenarioSection sections::shutter = {.name = "shutter",
                                           .help = "whether all rows are exposed together or one after the other",
                                           .in_camera_file = true,
                                           .read = read_shutter,
                                           .settle = nullptr,
                                           .truth = shutter_truth,
                                           .ideal = ideal_shutter};

}  // namespace glidelab::render
