#include "validate/requirement_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/parallel.h"
#include "core/quantile.h"
#include "diagnose/trajectory_results.h"
#include "validate/comparison.h"
#include "validate/film_studio.h"
#include "validate/made_tracks.h"
#include "validate/sweep_design.h"
#include "validate/sweep_run.h"

namespace glidelab::validate {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Errors of one estimator in one quantity of one configuration, over the runs.
struct Errors {
  std::string estimator, configuration, quantity;
  std::vector<double> errors;
  bool missing = false;
};

void add_errors(const std::vector<QuantityComparison>& quantities, std::vector<Errors>& all) {
  for (const QuantityComparison& q : quantities) {
    if (!q.truth) continue;
    auto found = std::find_if(all.begin(), all.end(), [&](const Errors& e) {
      return e.estimator == q.estimator && e.configuration == q.configuration && e.quantity == q.quantity;
    });
    if (found == all.end()) found = all.insert(all.end(), {q.estimator, q.configuration, q.quantity, {}, false});
    if (q.error) {
      found->errors.push_back(*q.error);
    } else {
      found->missing = true;
    }
  }
}

double measure_of(const Errors& errors, Target::Measure measure) {
  if (errors.missing || errors.errors.empty()) return kNever;
  double sum = 0.0, square = 0.0;
  for (const double error : errors.errors) {
    sum += error;
    square += error * error;
  }
  const double n = static_cast<double>(errors.errors.size());
  if (measure == Target::Measure::bias) return std::abs(sum / n);
  return std::sqrt(square / n) * (measure == Target::Measure::error95 ? core::kNormal95 : 1.0);
}

/// The better estimator's measure, each judged by its worst configuration.
void judge_errors(const std::vector<Errors>& all, const Target& target, TargetResult& result) {
  for (const char* estimator : {"phase-diagram", "trajectory"}) {
    double worst = 0.0;
    std::size_t runs = 0;
    for (const Errors& errors : all) {
      if (errors.estimator != estimator || errors.quantity != target.quantity) continue;
      worst = std::max(worst, measure_of(errors, target.measure));
      runs = errors.errors.size();
    }
    if (runs == 0 || (result.found && *result.found <= worst)) continue;
    result.found = worst;
    result.found_sd = worst / std::sqrt(2.0 * static_cast<double>(runs));
    result.estimator = estimator;
  }
}

}  // namespace

MadeTracks RecordedRuns::tracks_of(const Setting& setting, const MadeTracks& clean, std::uint64_t run,
                                   Confirm confirm) {
  const std::uint64_t seed = seed_of(sweep_, point_ * options_.runs + run);
  if (confirm == Confirm::clips) {
    std::unique_ptr<FilmStudio>& studio = studios_[run];
    if (!studio) studio = std::make_unique<FilmStudio>(setting.scenario, seed, 1, stage_);
    return studio->film(setting.scenario, seed, 1);
  }
  // Clips of one scenario have about one noise: their root mean square.
  const std::vector<double> noise_m = noise_of(setting, clean.truth);
  double square = 0.0;
  for (const double noise : noise_m) square += noise * noise / static_cast<double>(noise_m.size());
  return with_noise(clean, std::sqrt(square), seed);
}

bool RecordedRuns::judge(const Setting& setting, Confirm confirm, std::vector<TargetResult>& results) {
  for (TargetResult& result : results) result.found.reset();
  // A studio whose clips go through a file draws what stands still with each of them.
  if (confirm == Confirm::clips && !stage_ && !render::lossy(setting.scenario.codec)) {
    stage_ = render::set_stage(setting.scenario, options_.jobs);
  }
  std::vector<std::vector<QuantityComparison>> of_runs(options_.runs);
  base::for_each_parallel(options_.runs, options_.jobs, [&](std::size_t run) {
    if (options_.before_run) options_.before_run();
    const MadeTracks clean = make_tracks(setting.scenario, seed_of(sweep_, point_ * options_.runs + run));
    const core::AnalysisResults lines = phase_diagram_of(tracks_of(setting, clean, run, confirm), {});
    of_runs[run] = compare_quantities(lines, clean.truth);
    const auto fits = compare_quantities(diagnose::with_trajectory_fits(lines), clean.truth);
    of_runs[run].insert(of_runs[run].end(), fits.begin(), fits.end());
  });
  std::vector<Errors> all;
  for (const std::vector<QuantityComparison>& of_run : of_runs) add_errors(of_run, all);
  bool reached = true;
  for (std::size_t t = 0; t < options_.targets.size(); ++t) {
    judge_errors(all, options_.targets[t], results[t]);
    reached = reached && results[t].found && *results[t].found <= options_.targets[t].value;
  }
  return reached;
}

std::vector<Limit> RecordedRuns::limits(const std::vector<TargetResult>& results) {
  std::vector<Limit> limits;
  const Setting& setting = setting_;
  const auto try_without = [&](const char* name, const Setting& changed, Confirm confirm) {
    std::vector<TargetResult> then(options_.targets.size());
    judge(changed, confirm, then);
    double gain = 0.0;
    for (std::size_t t = 0; t < then.size(); ++t) {
      if (results[t].found && then[t].found) gain = std::max(gain, *results[t].found / *then[t].found);
    }
    if (std::isfinite(gain) && gain > 0.0) limits.push_back({name, gain});
  };
  Setting changed = setting;
  changed.scenario.recording.clock = {};
  try_without("the camera's clock (even instead, by runs)", changed, options_.confirm);
  if (options_.confirm != Confirm::clips) return limits;
  if (setting.scenario.recording.shutter.rolling) {
    changed = setting;
    changed.scenario.recording.shutter.rolling = false;
    try_without("rolling shutter (global instead, by runs)", changed, options_.confirm);
  }
  if (render::lossy(setting.scenario.codec)) {
    changed = setting;
    changed.scenario.codec = render::Codec::ffv1;
    try_without("codec (lossless instead, by runs)", changed, options_.confirm);
  }
  try_without("lens, calibration and tracking (true positions with the expected noise, by runs)", setting,
              Confirm::tracks);
  return limits;
}

}  // namespace glidelab::validate
