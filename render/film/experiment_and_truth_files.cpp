#include "render/film/experiment_and_truth_files.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "base/toml/toml_set.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario_sections.h"
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
                                        {"clips", clips}, {"camera", sections_truth(scenario)}};
  return truth.dump(2) + "\n";
}

}  // namespace glidelab::render
