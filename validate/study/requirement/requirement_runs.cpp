#include "validate/study/requirement/requirement_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/parallel.h"
#include "fit/estimators.h"
#include "validate/film/film_studio.h"
#include "validate/study/requirement/target.h"
#include "validate/study/sweep/design/sweep_design.h"
#include "validate/study/sweep/sweep_run.h"
#include "validate/tracks/made_tracks.h"
#include "validate/truth/comparison.h"

namespace glidelab::validate {
namespace {

/// Errors of one estimator in one quantity of one configuration, run by run; infinite where there is no answer.
struct Errors {
  std::string estimator, configuration, quantity;
  std::vector<double> errors;
};

void add_errors(const std::vector<QuantityComparison>& quantities, std::vector<Errors>& all) {
  for (const QuantityComparison& q : quantities) {
    if (!q.truth) continue;
    auto found = std::find_if(all.begin(), all.end(), [&](const Errors& e) {
      return e.estimator == q.estimator && e.configuration == q.configuration && e.quantity == q.quantity;
    });
    if (found == all.end()) found = all.insert(all.end(), {q.estimator, q.configuration, q.quantity, {}});
    found->errors.push_back(q.error.value_or(std::numeric_limits<double>::infinity()));
  }
}

/// The better estimator's measure, each judged by its worst configuration.
void judge_errors(const std::vector<Errors>& all, const Target& target, TargetResult& result) {
  for (const fit::Estimator& estimator : fit::judged_estimators()) {
    std::optional<ErrorMeasure> worst;
    for (const Errors& errors : all) {
      if (errors.estimator != estimator.name || errors.quantity != target.quantity) continue;
      const ErrorMeasure measure = measure_errors(errors.errors, target);
      if (!worst || measure.value > worst->value) worst = measure;
    }
    if (!worst || (result.found && *result.found <= worst->value)) continue;
    result.found = worst->value;
    result.found_sd = worst->sd;
    result.runs = worst->runs;
    result.beyond = worst->beyond;
    result.estimator = estimator.name;
  }
}

/// Of one target, or of several: one that is missed decides.
Verdict verdict_of(const std::vector<TargetResult>& results, const std::vector<Target>& targets) {
  bool sure = true;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const TargetResult& result = results[t];
    if (!result.found || !std::isfinite(*result.found)) return Verdict::missed;
    if (*result.found - result.found_sd > targets[t].value) return Verdict::missed;
    sure = sure && *result.found + result.found_sd <= targets[t].value;
  }
  return sure ? Verdict::reached : Verdict::undecided;
}

}  // namespace

MadeTracks RecordedRuns::tracks_of(const Setting& setting, const MadeTracks& clean, std::uint64_t run,
                                   Confirm confirm) {
  const std::uint64_t seed = seed_of(sweep_, point_ * options_.runs + run);
  if (confirm == Confirm::clips) {
    std::unique_ptr<FilmStudio>& studio = studios_[run];
    if (!studio) {
      studio = std::make_unique<FilmStudio>(setting.scenario, seed, 1, stage_,
                                            [this](std::string_view, double) { options_.watch(); });
    }
    return studio->film(setting.scenario, seed, 1,
                        setting.lens_known ? true_camera(setting.scenario.camera) : std::nullopt);
  }
  // Clips of one scenario have about one noise: their root mean square.
  const std::vector<double> noise_m = noise_of(setting, clean.truth);
  double square = 0.0;
  for (const double noise : noise_m) square += noise * noise / static_cast<double>(noise_m.size());
  return with_noise(clean, std::sqrt(square), seed);
}

Verdict RecordedRuns::judge(const Setting& setting, Confirm confirm, std::vector<TargetResult>& results) {
  for (TargetResult& result : results) result.found.reset();
  // A studio whose clips go through a file draws what stands still with each of them.
  if (confirm == Confirm::clips && !stage_ && !render::lossy(setting.scenario.codec)) {
    stage_ = render::set_stage(setting.scenario, options_.jobs, options_.watch);
  }
  std::vector<std::vector<QuantityComparison>> of_runs(options_.runs);
  base::for_each_parallel(options_.runs, options_.jobs, [&](std::size_t run) {
    if (options_.before_run) options_.before_run();
    const MadeTracks clean = make_tracks(setting.scenario, seed_of(sweep_, point_ * options_.runs + run));
    const MadeTracks made = tracks_of(setting, clean, run, confirm);
    const auto analyze = [&](core::LineMethod lines) {
      return analyze_tracks(made, core::MotionOptions{.lines = lines});
    };
    for (const core::AnalysisResults& by : fit::estimate_each(fit::judged_estimators(), analyze)) {
      const auto quantities = compare_quantities(by, clean.truth);
      of_runs[run].insert(of_runs[run].end(), quantities.begin(), quantities.end());
    }
  });
  std::vector<Errors> all;
  for (const std::vector<QuantityComparison>& of_run : of_runs) add_errors(of_run, all);
  for (std::size_t t = 0; t < options_.targets.size(); ++t) judge_errors(all, options_.targets[t], results[t]);
  return verdict_of(results, options_.targets);
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
  if (true_camera(setting.scenario.camera)) {
    changed = setting;
    changed.lens_known = true;
    try_without("calibration (the true camera instead, by runs)", changed, options_.confirm);
  }
  try_without("lens, calibration and tracking (true positions with the expected noise, by runs)", setting,
              Confirm::tracks);
  return limits;
}

}  // namespace glidelab::validate
