/// glidelab validate SCENARIO.toml: the closed loop, from a scenario to recovered values compared with their truth;
/// with --baseline or --write-baseline, whether the analysis is worse than it was.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/preview.h"
#include "core/experiment/experiment.h"
#include "fit/outside/outside_estimator.h"
#include "render/scenario/scenario.h"
#include "report/analysis/result_files.h"
#include "report/html/gnuplot.h"
#include "report/text/display_text.h"
#include "report/text/outside_text.h"
#include "report/validation/gate_text.h"
#include "report/validation/validation_report.h"
#include "validate/film/run_validation.h"
#include "validate/study/baseline/gate.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

/// --baseline, --write-baseline: is the analysis worse than it was?
struct BaselineGate {
  std::string compare;  ///< --baseline
  std::string write;    ///< --write-baseline
  std::uint64_t runs = 100;
  std::optional<double> noise_m = {};
  bool wanted() const { return !compare.empty() || !write.empty(); }
};

struct ValidateOptions {
  CommonOptions common;
  std::string scenario;
  BaselineGate gate;
  OutsideOptions outside;
};

/// NotMet if something is worse. If there is an outside estimator, it alone is judged.
void run_baseline_gate(const ValidateOptions& asked, const std::optional<fit::OutsideEstimator>& outside) {
  const BaselineGate& gate = asked.gate;
  const CommonOptions& common = asked.common;
  if (!gate.write.empty()) {
    check_file_writable(gate.write);
    check_own_file(gate.write, "--write-baseline", "{");
    std::error_code error;  // of a file that does not exist
    if (!gate.compare.empty() && fs::equivalent(gate.compare, gate.write, error)) {
      throw base::InputError(base::Issue{gate.write, 0, "--write-baseline", "the file of --baseline",
                                         "another file: the baseline of the comparison is not overwritten"});
    }
  }
  const std::string text = base::read_file(asked.scenario);
  const render::Scenario scenario = render::read_scenario(text, asked.scenario, render::ScenarioChecks::values);
  validate::GateOptions options;
  options.baseline = gate.compare;
  options.noise_m = gate.noise_m;
  options.seed = common.seed;
  options.runs = gate.runs;
  options.jobs = common.jobs;
  options.outside = outside;
  ProgressDisplay display(common.quiet, common.verbose);
  validate::Gate found = validate::run_gate(scenario, text, asked.scenario, options, display.callback());
  display.clear();
  throw_if_interrupted();
  print_result(common.json ? validate::baseline_json(found.now) : report::errors_table(found.now));
  if (found.outside) say(common, report::outside_text(*found.outside));
  if (!gate.write.empty()) write_whole(gate.write, validate::baseline_json(found.now));
  if (!found.then) return;
  found = validate::compared(std::move(found));
  say(common, report::power_text(*found.comparison));
  say(common, report::detectable_text(found));
  if (const std::string weak = report::weak_text(found); !weak.empty()) say(common, weak);
  const std::string worse = report::worse_text(*found.comparison);
  if (worse.empty()) {
    say(common, "nothing is worse than the baseline");
    return;
  }
  throw base::NotMet(fmt::format("worse than {}:\n{}", gate.compare, worse));
}

/// Copies the trajectories, as `simulate` writes them, next to the other results.
void copy_trajectories(const fs::path& truth, const fs::path& dir) {
  for (const fs::directory_entry& entry : fs::directory_iterator(truth)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("trajectory-")) base::write_file(dir / name, base::read_file(entry.path()));
  }
}

void validate_command(const ValidateOptions& options) {
  const std::optional<fit::OutsideEstimator> outside = options.outside.estimator();
  if (options.gate.wanted()) return run_baseline_gate(options, outside);
  const render::Scenario scenario = render::read_scenario(options.scenario);
  report::check_gnuplot();
  const fs::path out = output_folder(options.common, "validate", options.scenario);
  check_writable(out);
  check_replaceable(out / "experiment", out / "experiment.truth");
  base::StagedOutput staged(out);
  const fs::path experiment = staged.dir() / "experiment";
  const fs::path truth = staged.dir() / "experiment.truth";
  fs::create_directory(experiment);
  fs::create_directory(truth);

  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const base::Progress progress = display.callback();
  validate::ValidationOptions run;
  run.render = {.seed = options.common.seed.value_or(scenario.seed), .jobs = options.common.jobs};
  run.analysis.jobs = options.common.jobs;
  run.outside = outside;
  const validate::ValidationResult result = validate::run_validation(scenario, experiment, truth, run, progress);

  report::write_analysis_files(result.results, staged.dir());
  copy_trajectories(truth, staged.dir());
  const std::string comparison = report::comparison_json(result.comparison);
  base::write_file(staged.dir() / "comparison.json", comparison);
  if (!result.outside_json.empty()) {
    base::write_file(staged.dir() / fmt::format("results-{}.json", report::file_name_part(outside->name)),
                     result.outside_json);
  }
  const std::vector<core::Preview> previews = core::previews_of({experiment}, result.results, progress, {});
  report::write_page(
      staged.dir(), "report.html",
      report::validation_report(scenario.motion.name, result.results, result.comparison, previews, progress));
  throw_if_interrupted();
  check_replaceable(out / "experiment", out / "experiment.truth");  // files may have appeared there in the meantime
  staged.publish_files();
  display.clear();

  print_answer(options.common.json ? comparison : report::comparison_text(result.comparison));
  say(options.common, fmt::format("report: {}", (out / "report.html").string()));
}

}  // namespace

void add_validate(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* command =
      app.add_subcommand("validate", "Film a scenario, analyse the images, and compare the result with the truth");
  command->add_option("SCENARIO", options->scenario, "A scenario file (docs/reference/scenario.md)")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--baseline", options->gate.compare,
                   "Instead of filming, analyse replicated tracks of the scenario; exit status 4 if errors are "
                   "significantly worse than in this file")
      ->type_name("FILE");
  command->add_option("--write-baseline", options->gate.write, "Store these errors, for --baseline")->type_name("FILE");
  CLI::Option* runs = command->add_option("--runs", options->gate.runs, "Replicates for a baseline")
                          ->type_name("N")
                          ->check(CLI::Range(10, 1000000))
                          ->capture_default_str();
  CLI::Option* noise = command
                           ->add_option("--noise-m", options->gate.noise_m,
                                        "With --write-baseline: standard deviation of a position; default: 2e-5; "
                                        "--baseline takes the stored one and refuses another")
                           ->type_name("METRES")
                           ->check(check_noise_m);
  add_outside_options(*command, options->outside);
  add_common_options(
      *command, options->common, "glidelab-out/validate-<name of the scenario file>",
      "Seed of the noise; default: the scenario's; with --write-baseline 1, with --baseline one other than the file's");
  command->callback([options, runs, noise, &chosen] {
    for (const CLI::Option* option : {runs, noise}) {
      if (option->count() > 0 && !options->gate.wanted()) {
        throw CLI::RequiresError(option->get_name(), "--baseline or --write-baseline");
      }
    }
    chosen = [options] { validate_command(*options); };
  });
}

}  // namespace glidelab::app
