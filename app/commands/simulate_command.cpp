/// glidelab simulate SCENARIO.toml: the true motions, as trajectory-<clip>.csv.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "render/scenario/clip_length.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"
#include "sim/motion/simulate.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;
using report::Json;

struct SimulateOptions {
  CommonOptions common;
  std::string scenario;
  std::optional<double> rate_hz;
};

/// What is told of one clip, once its file is written.
struct SimulatedClip {
  std::string name;
  std::string configuration;
  std::string file;
  sim::Trajectory trajectory;
};

/// The motion at the middle of each exposure, on the recording's clock: the first frame's middle is t = 0.
sim::Trajectory recorded(const sim::Body& body, const sim::MotionSetup& motion, const render::Recording& recording) {
  const double first_middle_s = 0.5 * recording.exposure_s;
  std::vector<double> times_s(render::frame_count(recording, motion));
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    times_s[k] = static_cast<double>(k) / recording.frame_rate_hz + first_middle_s;
  }
  sim::Trajectory trajectory = sim::simulate(body, motion.x0_m, motion.v0_m_s, times_s);
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    trajectory.states[k].t_s = static_cast<double>(k) / recording.frame_rate_hz;
  }
  for (sim::ModeChange& change : trajectory.changes) change.t_s -= first_middle_s;
  return trajectory;
}

/// InputError where a trajectory has too many states, with what it would take.
void check_length(const SimulateOptions& options, const sim::MotionScenario& scenario,
                  const render::Recording& recording) {
  constexpr double kBytesOfRow = 65.0;  // of the CSV
  for (const sim::ConfigurationSetup& configuration : scenario.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      const std::size_t states = render::frame_count(recording, motion);
      if (states <= render::kMostFrames) continue;
      throw base::InputError(base::Issue{
          options.scenario, 0, "--rate",
          fmt::format("{:.6g} Hz, for clip \"{}\" of {:.6g} s {} states or {:.3g} GB", recording.frame_rate_hz,
                      motion.name, motion.duration_s, states, 1e-9 * kBytesOfRow * static_cast<double>(states)),
          fmt::format("at most {} states in a clip, {:.6g} Hz", render::kMostFrames,
                      static_cast<double>(render::kMostFrames) / motion.duration_s)});
    }
  }
}

std::string trajectory_csv(const sim::Trajectory& trajectory) {
  base::CsvWriter table("t_s,x_m,v_m_s,a_m_s2,mode");
  for (const sim::State& state : trajectory.states) {
    table.number(state.t_s).number(state.x_m).number(state.v_m_s).number(state.a_m_s2);
    table.text(sim::name_of(state.mode));
    table.end_row();
  }
  return table.str();
}

bool is_reversal(const sim::ModeChange& change) {
  return change.from != sim::Mode::stick && change.to != sim::Mode::stick && change.from != change.to;
}

Json changes_json(const std::vector<sim::ModeChange>& changes, bool reversals_only) {
  Json list = Json::array();
  for (const sim::ModeChange& change : changes) {
    if (reversals_only && !is_reversal(change)) continue;
    list.push_back({{"t_s", change.t_s},
                    {"x_m", change.x_m},
                    {"from", sim::name_of(change.from)},
                    {"to", sim::name_of(change.to)}});
  }
  return list;
}

std::string as_json(const std::vector<SimulatedClip>& clips) {
  Json document{{"format", 1}, {"clips", Json::array()}};
  for (const SimulatedClip& clip : clips) {
    document["clips"].push_back({{"name", clip.name},
                                 {"configuration", clip.configuration},
                                 {"states", clip.trajectory.states.size()},
                                 {"file", clip.file},
                                 {"reversals", changes_json(clip.trajectory.changes, true)},
                                 {"mode_changes", changes_json(clip.trajectory.changes, false)},
                                 {"dissipated_j", clip.trajectory.dissipated_j}});
  }
  return report::json_text(document);
}

std::string as_table(const std::vector<SimulatedClip>& clips) {
  std::vector<std::vector<std::string>> rows = {
      {"clip", "configuration", "states", "from x (m)", "to x (m)", "last v (m/s)", "changes of mode at (s)"}};
  for (const SimulatedClip& clip : clips) {
    std::string changes;
    for (const sim::ModeChange& change : clip.trajectory.changes) {
      changes += fmt::format("{}{:.4f} to {}", changes.empty() ? "" : ", ", change.t_s, sim::name_of(change.to));
    }
    const std::vector<sim::State>& states = clip.trajectory.states;
    rows.push_back({clip.name, clip.configuration, fmt::format("{}", states.size()),
                    fmt::format("{:.4f}", states.front().x_m), fmt::format("{:.4f}", states.back().x_m),
                    fmt::format("{:+.4f}", states.back().v_m_s), changes});
  }
  return report::text_table(rows, 2);
}

void simulate_command(const SimulateOptions& options) {
  const render::Scenario scenario = render::read_scenario(options.scenario);
  const fs::path out = output_folder(options.common, "simulate", options.scenario);
  check_writable(out);
  base::StagedOutput staged(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const base::Progress progress = display.callback();
  render::Recording recording = scenario.recording;
  if (options.rate_hz) recording.frame_rate_hz = *options.rate_hz;
  check_length(options, scenario.motion, recording);

  std::vector<SimulatedClip> clips;
  std::size_t configurations_done = 0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      progress("simulating",
               static_cast<double>(configurations_done) / static_cast<double>(scenario.motion.configurations.size()));
      SimulatedClip clip{motion.name, configuration.name, fmt::format("trajectory-{}.csv", motion.name),
                         recorded(configuration.body, motion, recording)};
      base::write_file(staged.dir() / clip.file, trajectory_csv(clip.trajectory));
      clips.push_back(std::move(clip));
    }
    ++configurations_done;
  }
  throw_if_interrupted();
  staged.publish_files();
  display.clear();

  print_result(options.common.json ? as_json(clips) : as_table(clips));
  say(options.common, fmt::format("trajectories: {}", out.string()));
}

std::string check_rate(const std::string& text) {
  double value = 0.0;
  if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value) || !(value > 0.0) || value > 1e6) {
    return fmt::format("\"{}\" is not a number of hertz above 0, up to 1000000", text);
  }
  return {};
}

}  // namespace

void add_simulate(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command =
      app.add_subcommand("simulate", "Simulate the gliders of a scenario and write their true trajectories");
  command->add_option("SCENARIO", options->scenario, "A scenario file (docs/reference/scenario.md)")
      ->type_name("FILE")
      ->required();
  command->add_option("--rate", options->rate_hz, "States per second; default: the scenario's frame rate")
      ->type_name("HZ")
      ->check(check_rate);
  add_common_options(*command, options->common, "glidelab-out/simulate-<name of the scenario file>",
                     "Accepted for consistency; has no effect here");
  command->callback([options, &chosen] { chosen = [options] { simulate_command(*options); }; });
}

}  // namespace glidelab::app
