/// glidelab coverage SCENARIO.toml [--noise-m SD]: do the stated intervals contain the truth as often as stated?
#include <fmt/format.h>

#include <algorithm>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <set>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "fit/estimators.h"
#include "render/scenario/scenario.h"
#include "report/coverage/coverage_report.h"
#include "report/html/gnuplot.h"
#include "validate/study/coverage/interval_coverage.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct CoverageCommand {
  CommonOptions common;
  std::string scenario;
  validate::CoverageOptions coverage;
  double bandwidth_s = 0.0;
  double noise_m = 0.0;
  std::vector<double> levels;  ///< in per cent
  OutsideOptions outside;
};

std::string check_level(const std::string& text) {
  double value = 0.0;
  if (CLI::detail::lexical_cast(text, value) && value > 0.0 && value < 100.0) return {};
  return fmt::format("\"{}\" is not a percentage above 0 and below 100", text);
}

void coverage_command(const CoverageCommand& options, bool bandwidth_given, bool noise_given) {
  const std::optional<fit::OutsideEstimator> outside = options.outside.estimator();
  // With a given noise there is no camera, so it need not see the motions.
  const render::Scenario scenario =
      render::read_scenario(base::read_file(options.scenario), options.scenario,
                            noise_given ? render::ScenarioChecks::values : render::ScenarioChecks::all);
  report::check_gnuplot();
  const fs::path out = output_folder(options.common, "coverage", options.scenario);
  check_writable(out);
  base::StagedOutput staged(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  validate::CoverageOptions wanted = options.coverage;
  wanted.seed = options.common.seed.value_or(scenario.seed);
  wanted.jobs = options.common.jobs;
  wanted.outside = outside;
  if (noise_given) wanted.noise_sd_m = options.noise_m;
  if (!options.levels.empty()) wanted.levels.clear();
  for (const double percent : options.levels) wanted.levels.push_back(percent / 100.0);
  if (bandwidth_given) wanted.bandwidth_s = options.bandwidth_s;
  const validate::Coverage coverage = validate::measure_coverage(scenario, wanted, display.callback());
  const std::string json = report::coverage_json(coverage);
  base::write_file(staged.dir() / "coverage.json", json);
  report::write_page(staged.dir(), "report.html",
                     report::coverage_page(fmt::format("Coverage: {}", scenario.motion.name), coverage));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();
  print_answer(options.common.json ? json : report::coverage_text(coverage));
  say(options.common, fmt::format("report: {}", (out / "report.html").string()));
  if (std::all_of(coverage.rows.begin(), coverage.rows.end(),
                  [](const validate::CoverageRow& row) { return row.determined == 0; })) {
    throw base::NotMet(
        fmt::format("{}: nothing to count: no estimator found a value whose truth is known. K/m and mu have a true "
                    "value only for viscous drag with Coulomb friction; under another law only the inclination and the "
                    "terminal velocity have one, and only where the motions determine them",
                    options.scenario));
  }
  if (bandwidth_given && std::all_of(coverage.rows.begin(), coverage.rows.end(), [](const validate::CoverageRow& row) {
        return row.determined == 0 || row.estimator != fit::default_estimator().name;
      })) {
    throw base::NotMet(fmt::format("{}: with --bandwidth {} the phase diagram finds no value in any replicate",
                                   options.scenario, options.bandwidth_s));
  }
  // A row that fails at several levels is reported once.
  std::set<std::string> failing;
  for (const validate::CoverageFailure& one : validate::too_narrow(coverage)) {
    failing.insert(one.row.configuration + "\n" + one.row.estimator + "\n" + one.row.quantity);
  }
  if (!failing.empty()) {
    throw base::NotMet(fmt::format(
        "{} of the stated intervals contain the true value less often than stated (exact binomial test at 1 %, "
        "corrected for the number of intervals and levels); the table is in {}",
        failing.size(), (out / "report.html").string()));
  }
}

}  // namespace

void add_coverage(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<CoverageCommand>();
  CLI::App* command = app.add_subcommand(
      "coverage",
      "Analyse many replicates of a scenario's motions, and count how often the intervals contain the true value");
  command->add_option("SCENARIO", options->scenario, "A scenario file (docs/reference/scenario.md)")
      ->type_name("FILE")
      ->required();
  CLI::Option* noise =
      command
          ->add_option("--noise-m", options->noise_m,
                       "Standard deviation of the position noise in metres (no images are rendered); default: the "
                       "smallest that the scenario's camera, light and marker allow, clip by clip")
          ->type_name("METRES")
          ->check(check_noise_m);
  command->add_option("--replicates", options->coverage.replicates, "Number of replicates")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--level", options->levels,
                   "Confidence levels of the intervals to count, in per cent, each above 0 and below 100")
      ->type_name("PERCENT")
      ->check(check_level)
      ->default_str("50 68 90 95 99");
  CLI::Option* bandwidth = command
                               ->add_option("--bandwidth", options->bandwidth_s,
                                            "Bandwidth of the phase diagram in seconds; default: chosen clip by clip")
                               ->type_name("SECONDS")
                               ->check(check_above_0);
  add_outside_options(*command, options->outside);
  add_common_options(*command, options->common, "glidelab-out/coverage-<name of the scenario file>",
                     "Seed of the noise; default: the scenario's");
  command->callback([options, bandwidth, noise, &chosen] {
    chosen = [options, bandwidth, noise] { coverage_command(*options, bandwidth->count() > 0, noise->count() > 0); };
  });
}

}  // namespace glidelab::app
