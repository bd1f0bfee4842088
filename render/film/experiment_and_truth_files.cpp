#include "render/film/experiment_and_truth_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/toml/toml_set.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scene.h"
#include "sim/motion/true_parameters.h"

namespace glidelab::render {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// A float of TOML, with a point; 12 digits hide what a conversion from degrees and back leaves.
std::string number(double value) {
  std::string text = fmt::format("{:.12g}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

const char* word_of(sim::Launched launched) {
  return launched == sim::Launched::up ? "up" : launched == sim::Launched::down ? "down" : "released";
}

nlohmann::ordered_json maybe(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
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

/// What of the optics is not as in a plain scenario.
void add_optics(const Scenario& scenario, nlohmann::ordered_json& camera) {
  if (!scenario.vignetting.none()) {
    nlohmann::ordered_json radial = nlohmann::ordered_json::array();
    for (const Eigen::Vector2d& entry : scenario.vignetting.radial) radial.push_back({entry.x(), entry.y()});
    camera["vignetting"] = {{"cos4", scenario.vignetting.cos4}, {"radial", radial}};
  }
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
  const Light& light = scenario.light;
  camera["light"] = {{"level", light.level},
                     {"gradient_per_m", {light.gradient_per_m.x(), light.gradient_per_m.y()}},
                     {"flicker_depth", light.flicker_depth},
                     {"flicker_hz", light.flicker_hz},
                     {"ring_light", light.ring_light},
                     {"reflections", light.reflections.size()}};
  camera["mount"] = {{"focal_change", scenario.mount.focal_change}, {"motions", scenario.mount.motions.size()}};
}

nlohmann::ordered_json camera_json(const Scenario& scenario) {
  const Camera& camera = scenario.camera;
  nlohmann::ordered_json rotation = nlohmann::ordered_json::array();
  for (int row = 0; row < 3; ++row) {
    rotation.push_back({camera.X_WC.linear()(row, 0), camera.X_WC.linear()(row, 1), camera.X_WC.linear()(row, 2)});
  }
  const Eigen::Vector3d eye = camera.X_WC.translation();
  nlohmann::ordered_json json = {
      {"name", scenario.camera_name},
      {"width_px", camera.width_px},
      {"height_px", camera.height_px},
      {"focal_px", {camera.focal_px.x(), camera.focal_px.y()}},
      {"center_px", {camera.center_px.x(), camera.center_px.y()}},
      {"lens", name_of(camera.lens.model)},
      {"distortion", distortion_json(camera.lens)},
      {"one_to_one_radius", finite(fold_radius(camera.lens))},
      {"rotation_WC", rotation},
      {"position_m", {eye.x(), eye.y(), eye.z()}},
      {"frame_rate_hz", scenario.recording.frame_rate_hz},
      {"exposure_s", scenario.recording.exposure_s},
      {"clock",
       {{"rate_error_ppm", scenario.recording.clock.rate_error_ppm},
        {"jitter_s", scenario.recording.clock.jitter_s},
        {"dropped_fraction", scenario.recording.clock.dropped_fraction},
        {"duplicated_fraction", scenario.recording.clock.duplicated_fraction},
        {"variable", scenario.recording.clock.variable}}},
      {"codec", name_of(scenario.codec)},
      {"shutter",
       {{"kind", scenario.recording.shutter.rolling ? "rolling" : "global"},
        {"line_readout_s", scenario.recording.shutter.line_readout_s},
        {"first_row", scenario.recording.shutter.bottom_first ? "bottom" : "top"}}},
      {"sensor",
       {{"bit_depth", scenario.sensor.bit_depth},
        {"full_well_e", scenario.sensor.full_well_e},
        {"read_noise_e", scenario.sensor.read_noise_e},
        {"gain_dn_per_e", scenario.sensor.gain_dn_per_e},
        {"offset_dn", scenario.sensor.offset_dn},
        {"converter_bits", scenario.sensor.converter_bits.value_or(scenario.sensor.bit_depth)},
        {"dark_signal_e_s", scenario.sensor.pixels.dark_signal_e_s},
        {"prnu", scenario.sensor.pixels.prnu},
        {"dsnu_e", scenario.sensor.pixels.dsnu_e},
        {"hot_fraction", scenario.sensor.pixels.hot_fraction},
        {"dead_fraction", scenario.sensor.pixels.dead_fraction},
        {"tone", name_of(scenario.sensor.tone.kind)},
        {"colour", scenario.sensor.colour == Colour::bayer ? "bayer" : "mono"},
        {"quantum_efficiency", scenario.exposure.quantum_efficiency},
        {"white_e", electrons_of_white(scenario)}}}};
  add_optics(scenario, json);
  return json;
}

}  // namespace

std::string view_name(std::size_t i) {
  return fmt::format("calibration/view-{:02d}.png", i);
}

std::string plane_name(std::size_t i, std::size_t count) {
  return count == 1 ? "calibration/plane.png" : fmt::format("calibration/plane-{:02d}.png", i);
}

std::string experiment_toml(const Scenario& scenario) {
  std::string text;
  const auto line = [&](std::string_view key, const std::string& value) {
    text += fmt::format("{} = {}\n", key, value);
  };
  const auto table = [&](std::string_view name) { text += fmt::format("\n{}\n", name); };
  line("format", "1");
  line("name", base::toml_string(scenario.motion.name));
  line("gravity_m_s2", number(scenario.motion.gravity_m_s2));
  table("[camera]");
  line("frame_rate_hz", number(scenario.recording.frame_rate_hz));
  line("exposure_s", number(scenario.recording.exposure_s));
  const Shutter& shutter = scenario.recording.shutter;
  line("shutter", shutter.rolling ? "\"rolling\"" : "\"global\"");
  if (shutter.rolling) line("line_readout_s", number(shutter.line_readout_s));
  if (shutter.bottom_first) line("first_row", "\"bottom\"");
  line("bit_depth", fmt::format("{}", scenario.sensor.bit_depth));
  if (scenario.recording.clock.variable) line("time", "\"container\"");
  table("[calibration]");
  line("pattern", "\"chessboard\"");
  line("inner_corners", fmt::format("[{}, {}]", scenario.pattern.inner_columns, scenario.pattern.inner_rows));
  line("square_m", number(scenario.pattern.square_m));
  line("views", "\"calibration/view-*.png\"");
  line("plane", scenario.pattern.plane_x_m.size() == 1 ? "\"calibration/plane.png\"" : "\"calibration/plane-*.png\"");
  if (const auto region = plumb_region(scenario)) {
    table("[plumb]");
    line("view", "\"plumb.png\"");
    line("region", fmt::format("[{}, {}, {}, {}]", region->x, region->y, region->width, region->height));
  }
  table("[marker]");
  line("diameter_m", number(scenario.marker.diameter_m));
  line("height_m", number(scenario.marker.height_m));
  table("[track]");
  line("downhill", scenario.track.downhill > 0 ? "\"+X\"" : "\"-X\"");
  line("length_m", number(scenario.track.length_m));
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      table("[[clip]]");
      line("name", base::toml_string(motion.name));
      line("file", base::toml_string("clips/" + file_name_of(scenario.codec, scenario.compression, motion.name)));
      line("mass_kg", number(configuration.body.mass_kg));
      line("incline_deg", number(configuration.stated_incline_rad * kDegPerRad));
      if (configuration.stated_incline_sd_rad > 0.0) {
        line("incline_sd_deg", number(configuration.stated_incline_sd_rad * kDegPerRad));
      }
      line("launched", base::toml_string(word_of(motion.launched)));
      line("group", base::toml_string(configuration.group));
    }
  }
  return text;
}

double x_origin_m(const Scenario& scenario, double incline_rad) {
  return plane_board(scenario, 0).X_WP.translation().dot(track_direction_W(scenario.track, incline_rad));
}

std::string truth_json(const Scenario& scenario, std::uint64_t seed) {
  nlohmann::ordered_json configurations = nlohmann::ordered_json::array();
  nlohmann::ordered_json clips = nlohmann::ordered_json::array();
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    const std::optional<sim::LinearLaw> law = sim::linear_law(configuration.body);
    nlohmann::ordered_json names = nlohmann::ordered_json::array();
    for (const sim::MotionSetup& motion : configuration.motions) {
      names.push_back(motion.name);
      const FrameClock clock(scenario.recording.clock, scenario.recording.frame_rate_hz, seed,
                             static_cast<std::uint32_t>(clips.size()));
      clips.push_back({{"name", motion.name},
                       {"configuration", configuration.name},
                       {"frames", clock.frames_of(frame_count(scenario.recording, motion))},
                       {"x_origin_m", x_origin_m(scenario, configuration.body.incline_rad)},
                       {"trajectory", "trajectory-" + motion.name + ".csv"},
                       {"marker", "marker-" + motion.name + ".csv"},
                       {"frame_times", "frames-" + motion.name + ".csv"}});
    }
    configurations.push_back(
        {{"name", configuration.name},
         {"mass_kg", configuration.body.mass_kg},
         {"stated_incline_deg", configuration.stated_incline_rad * kDegPerRad},
         {"group", configuration.group},
         {"k_over_m_1_s", law ? nlohmann::ordered_json(law->k_over_m_1_s) : nlohmann::ordered_json(nullptr)},
         {"mu", law ? nlohmann::ordered_json(law->mu) : nlohmann::ordered_json(nullptr)},
         {"alpha_deg", configuration.body.incline_rad * kDegPerRad},
         {"v_lim_m_s", maybe(sim::limit_speed_m_s(configuration.body))},
         {"clips", names}});
  }
  const nlohmann::ordered_json truth = {{"format", 1},    {"name", scenario.motion.name},
                                        {"seed", seed},   {"configurations", configurations},
                                        {"clips", clips}, {"camera", camera_json(scenario)}};
  return truth.dump(2) + "\n";
}

}  // namespace glidelab::render
