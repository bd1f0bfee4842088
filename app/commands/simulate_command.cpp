/// glidelab simulate SCENARIO.toml: the true motions, as trajectory-<clip>.csv.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/files/file_io.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario.h"
#include "report/simulation/simulation_report.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct SimulateOptions {
  CommonOptions common;
  std::string scenario;
  std::optional<double> rate_hz;
};

void simulate_command(const SimulateOptions& options) {
  const render::Scenario scenario = render::read_scenario(options.scenario);
  const fs::path out = output_folder(options.common, "simulate", options.scenario);
  check_writable(out);
  base::StagedOutput staged(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const base::Progress progress = display.callback();
  render::Recording recording = scenario.recording;
  if (options.rate_hz) recording.frame_rate_hz = *options.rate_hz;
  render::check_states(scenario.motion, recording, options.scenario, "--rate");

  std::vector<report::SimulatedClip> clips;
  std::size_t configurations_done = 0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      progress("simulating",
               static_cast<double>(configurations_done) / static_cast<double>(scenario.motion.configurations.size()));
      report::SimulatedClip clip{motion.name, configuration.name, fmt::format("trajectory-{}.csv", motion.name),
                                 render::recorded_motion(configuration.body, motion, recording)};
      base::write_file(staged.dir() / clip.file, report::trajectory_csv(clip.trajectory));
      clips.push_back(std::move(clip));
    }
    ++configurations_done;
  }
  throw_if_interrupted();
  staged.publish_files();
  display.clear();

  print_answer(options.common.json ? report::simulation_json(clips) : report::simulation_text(clips));
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
  add_common_options(*command, options->common, "glidelab-out/simulate-<name of the scenario file>");
  command->callback([options, &chosen] { chosen = [options] { simulate_command(*options); }; });
}

}  // namespace glidelab::app
