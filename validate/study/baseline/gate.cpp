#include "validate/study/baseline/gate.h"

#include <fmt/format.h>

#include <mutex>
#include <utility>

#include "base/errors.h"
#include "validate/made_tracks/outside_runs.h"

namespace glidelab::validate {
namespace {

/// The baseline, if its errors can be compared with those of these options.
Baseline comparable_baseline(const std::string& text, const std::string& file, const GateOptions& options) {
  Baseline then = read_baseline(options.baseline);
  const auto refuse = [&](const char* key, const std::string& found, const std::string& expected) {
    throw base::InputError(base::Issue{options.baseline.string(), 0, key, found, expected});
  };
  if (then.scenario != text) {
    refuse("scenario", "the text of another scenario",
           fmt::format("that of {}, unchanged since the baseline was written", file));
  }
  if (options.noise_m && *options.noise_m != then.noise_m) {
    refuse("--noise-m", fmt::format("{}", *options.noise_m),
           fmt::format("{}, as for the baseline, or the option left out", then.noise_m));
  }
  if (then.seed && options.seed == then.seed) {
    refuse("--seed", fmt::format("{}, with which the baseline was made", *then.seed),
           "another seed, or the option left out: with the same noise an unchanged analysis would prove nothing");
  }
  return then;
}

}  // namespace

Gate run_gate(const render::Scenario& scenario, const std::string& text, const std::string& file,
              const GateOptions& options, const base::Progress& progress) {
  Gate gate;
  if (!options.baseline.empty()) gate.then = comparable_baseline(text, file, options);
  BaselineOptions how;
  how.noise_m = gate.then ? gate.then->noise_m : options.noise_m.value_or(how.noise_m);
  how.runs = options.runs;
  how.seed = options.seed.value_or(gate.then ? other_seed(*gate.then) : how.seed);
  how.jobs = options.jobs;
  std::vector<fit::OutsideRun> outside_runs;
  std::mutex adding;
  const AnalyzeTracks by_outside = [&](const MadeTracks& made) {
    fit::OutsideOutcome outcome = run_outside_on_tracks(*options.outside, made);
    const std::lock_guard lock(adding);
    outside_runs.push_back(std::move(outcome.run));
    return std::vector<core::AnalysisResults>{std::move(outcome.results)};
  };
  gate.now = measure_baseline(scenario, text, how, options.outside ? by_outside : analyze_as_judged, progress);
  if (options.outside) gate.outside = fit::tally_of(*options.outside, outside_runs);
  return gate;
}

Gate compared(Gate gate) {
  if (!gate.then) return gate;
  gate.comparison = compare_baselines(*gate.then, gate.now);
  gate.detectable = detectable(*gate.then, gate.now, *gate.comparison);
  return gate;
}

}  // namespace glidelab::validate
