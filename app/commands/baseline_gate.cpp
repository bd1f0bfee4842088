#include "app/commands/baseline_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/number_text.h"
#include "render/scenario/scenario.h"
#include "report/text/display_text.h"
#include "report/text/outside_text.h"
#include "validate/made_tracks/outside_runs.h"
#include "validate/study/baseline/baseline.h"
#include "validate/study/baseline/baseline_comparison.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

std::string table(const validate::Baseline& baseline) {
  std::vector<std::vector<std::string>> rows = {
      {"configuration", "estimator", "quantity", "results", "mean error", "sd of errors", "covered", "efficiency"}};
  for (const validate::ErrorRecord& record : baseline.records) {
    rows.push_back({record.configuration, record.estimator, record.quantity,
                    fmt::format("{} / {}", record.answers, record.runs), base::number_text(record.mean, 3),
                    base::number_text(record.sd, 3), fmt::format("{} / {}", record.covered, record.answers),
                    record.efficiency > 0.0 ? base::number_text(record.efficiency, 2) : "–"});
  }
  return report::text_table(rows, 3);
}

/// Prints how large a worsening must be to be detected, and where that is large.
void say_power(const CommonOptions& common, const validate::Baseline& then, const validate::Baseline& now,
               const validate::BaselineComparison& comparison) {
  std::vector<std::vector<std::string>> rows = {{"configuration", "estimator", "quantity",
                                                 "errors larger by a factor of", "or mean error larger by",
                                                 fmt::format("runs for a factor of {}", validate::kSmallFactor)}};
  std::size_t weak = 0;
  std::uint64_t runs = 0;
  for (const validate::Detectable& of : validate::detectable(then, now, comparison)) {
    rows.push_back({of.configuration, of.estimator, of.quantity,
                    of.factor ? base::number_text(*of.factor, 3) : "not detected",
                    of.bias ? base::number_text(*of.bias, 2) : "–", fmt::format("{}", of.runs_for_small)});
    if (!of.weak()) continue;
    ++weak;
    runs = std::max(runs, of.runs_for_weak);
  }
  say(common,
      fmt::format(
          "smallest worsening that is detected with probability {}, and the number of runs, in the baseline and now, "
          "that detect errors {} times as large with the same probability:\n{}",
          validate::kDetectionProbability, validate::kSmallFactor, report::text_table(rows, 3)));
  if (weak == 0) return;
  say(common,
      fmt::format("warning: a weak gate: for {} of {} quantities only errors more than {} times as large are "
                  "detected with this probability; about {} runs, in the baseline and now (--runs), suffice for "
                  "a factor of {}",
                  weak, rows.size() - 1, validate::kWeakFactor, runs, validate::kWeakFactor));
}

}  // namespace

void run_baseline_gate(const BaselineGate& gate, const CommonOptions& common, const std::string& scenario_file,
                       const std::optional<fit::OutsideEstimator>& outside) {
  if (!gate.write.empty()) {
    check_file_writable(gate.write);
    check_own_file(gate.write, "--write-baseline", "{");
    std::error_code error;  // of a file that does not exist
    if (!gate.compare.empty() && fs::equivalent(gate.compare, gate.write, error)) {
      throw base::InputError(base::Issue{gate.write, 0, "--write-baseline", "the file of --baseline",
                                         "another file: the baseline of the comparison is not overwritten"});
    }
  }
  const std::string text = base::read_file(scenario_file);
  const render::Scenario scenario = render::read_scenario(text, scenario_file, render::ScenarioChecks::values);
  std::optional<validate::Baseline> then;
  if (!gate.compare.empty()) then = validate::read_baseline(gate.compare);
  if (then && then->scenario != text) {
    throw base::InputError(
        base::Issue{gate.compare, 0, "scenario", "the text of another scenario",
                    fmt::format("that of {}, unchanged since the baseline was written", scenario_file)});
  }
  if (then && gate.noise_m && *gate.noise_m != then->noise_m) {
    throw base::InputError(base::Issue{gate.compare, 0, "--noise-m", fmt::format("{}", *gate.noise_m),
                                       fmt::format("{}, as for the baseline, or the option left out", then->noise_m)});
  }
  if (then && then->seed && common.seed == then->seed) {
    throw base::InputError(base::Issue{
        gate.compare, 0, "--seed", fmt::format("{}, with which the baseline was made", *then->seed),
        "another seed, or the option left out: with the same noise an unchanged analysis would prove nothing"});
  }
  validate::BaselineOptions options;
  options.noise_m = then ? then->noise_m : gate.noise_m.value_or(options.noise_m);
  options.runs = gate.runs;
  options.seed = common.seed.value_or(then ? validate::other_seed(*then) : options.seed);
  options.jobs = common.jobs;
  ProgressDisplay display(common.quiet, common.verbose);
  std::vector<fit::OutsideRun> outside_runs;
  std::mutex adding;
  const validate::AnalyzeTracks by_outside = [&](const validate::MadeTracks& made) {
    fit::OutsideOutcome outcome = validate::run_outside_on_tracks(*outside, made);
    const std::lock_guard lock(adding);
    outside_runs.push_back(std::move(outcome.run));
    return std::vector<core::AnalysisResults>{std::move(outcome.results)};
  };
  const validate::Baseline now = validate::measure_baseline(
      scenario, text, options, outside ? by_outside : validate::analyze_as_judged, display.callback());
  display.clear();
  throw_if_interrupted();
  print_result(common.json ? validate::baseline_json(now) : table(now));
  if (outside) say(common, report::outside_text(fit::tally_of(*outside, outside_runs)));
  if (!gate.write.empty()) write_whole(gate.write, validate::baseline_json(now));
  if (!then) return;
  const validate::BaselineComparison comparison = validate::compare_baselines(*then, now);
  say(common, fmt::format("{} tests with an overall significance of {}; probability of detecting errors 1.5 times as "
                          "large: {:.2f}, a bias of half a standard deviation: {:.2f}, a doubled bandwidth: {:.2f}",
                          comparison.tests, comparison.significance, comparison.power_spread, comparison.power_bias,
                          comparison.power_doubled));
  say_power(common, *then, now, comparison);
  if (comparison.worse.empty()) {
    say(common, "nothing is worse than the baseline");
    return;
  }
  std::string what;
  for (const validate::Worse& worse : comparison.worse) {
    what += fmt::format("{} {} {}: {} was {}, is {} (p {:.1g})\n", worse.configuration, worse.estimator, worse.quantity,
                        worse.what, base::number_text(worse.then, 3), base::number_text(worse.now, 3), worse.p);
  }
  throw base::NotMet(fmt::format("worse than {}:\n{}", gate.compare, what));
}

}  // namespace glidelab::app
