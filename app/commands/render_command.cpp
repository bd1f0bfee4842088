/// glidelab render SCENARIO.toml: an experiment folder, and the truth in a folder beside it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/files/file_io.h"
#include "render/film/marker_view.h"
#include "render/film/render_experiment.h"
#include "render/scenario/scenario.h"
#include "report/text/json_numbers.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct RenderCommandOptions {
  CommonOptions common;
  std::string scenario;
  bool ideal = false;
};

void render_command(const RenderCommandOptions& options) {
  const render::Scenario scenario = render::read_scenario(options.scenario);
  const fs::path out = named_folder(options.common, "render", options.scenario);
  const fs::path truth = truth_beside(out);
  check_replaceable(out, truth);
  check_writable(out);
  check_writable(truth);
  base::StagedOutput staged_experiment(out);
  base::StagedOutput staged_truth(truth);

  for (const render::ClipView& view : render::views_of(scenario)) {
    if (view.outside > 0) say(options.common, render::sentence(view));
  }
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const std::uint64_t seed = options.common.seed.value_or(scenario.seed);
  const render::RenderSummary summary = render::render_experiment(
      scenario, staged_experiment.dir(), staged_truth.dir(),
      {.seed = seed, .jobs = options.common.jobs, .ideal = options.ideal}, display.callback());
  throw_if_interrupted();
  base::list_made_files(staged_truth.dir());
  base::list_made_files(staged_experiment.dir());
  check_replaceable(out, truth);  // files may have appeared there in the meantime
  staged_truth.publish_whole();
  try {
    staged_experiment.publish_whole();
  } catch (const base::EnvironmentError&) {  // no truth without its experiment
    staged_truth.take_back();
    throw;
  }
  display.clear();

  if (options.common.json) {
    print_result(report::json_text({{"format", 1},
                                    {"experiment", out.string()},
                                    {"truth", truth.string()},
                                    {"seed", seed},
                                    {"clips", summary.clips},
                                    {"frames", summary.frames}}));
  } else {
    print_result(fmt::format("{} clips, {} frames\nexperiment: {}\ntruth: {}\n", summary.clips, summary.frames,
                             out.string(), truth.string()));
  }
}

}  // namespace

void add_render(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<RenderCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "render", "Film a scenario: write an experiment folder as a camera would, and the truth next to it (DIR.truth)");
  command->footer(
      "DIR and DIR.truth are replaced as a whole if they hold only what render wrote there. If they hold anything "
      "else, or a file was changed, render leaves them alone and ends with status 1.");
  command->add_option("SCENARIO", options->scenario, "A scenario file (docs/reference/scenario.md)")
      ->type_name("FILE")
      ->required();
  command->add_flag("--ideal", options->ideal,
                    "Render sharp frames without noise or distortion, and write the marker's centre in each of them "
                    "next to the truth");
  add_common_options(*command, options->common, "glidelab-out/render-<name of the scenario file>",
                     "Seed of the camera's noise; default: the scenario's");
  command->callback([options, &chosen] { chosen = [options] { render_command(*options); }; });
}

}  // namespace glidelab::app
