#include "validate/study/requirement/requirement_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "base/errors.h"
#include "base/long_work.h"
#include "core/math/quantile.h"
#include "fit/estimators.h"
#include "validate/film/film_studio.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/study/requirement/target.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/one_run.h"
#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

std::vector<double> noise_without(const Setting& setting, const Truth& truth, const WithoutLimit& without) {
  if (setting.given_noise_m) return std::vector<double>(truth.clips.size(), *setting.given_noise_m);
  return predicted_noise_m(setting.scenario, truth, without);
}

double need_of(const Setting& setting, const WithoutLimit& without, const std::vector<Target>& targets) {
  const MadeTracks made = make_tracks(setting.scenario, 1);
  return hardest(bounds(made, noise_without(setting, made.truth, without), targets), targets);
}

}  // namespace

std::vector<double> noise_of(const Setting& setting, const Truth& truth) {
  return noise_without(setting, truth, {});
}

std::vector<TargetResult> bounds(const MadeTracks& made, const std::vector<double>& noise_m,
                                 const std::vector<Target>& targets) {
  std::vector<TargetResult> results(targets.size());
  if (std::any_of(noise_m.begin(), noise_m.end(), [](double noise) { return !std::isfinite(noise); })) {
    for (TargetResult& result : results) result.bound = kNever;
    return results;
  }
  const std::vector<LeastSd> all = least_sds(made.truth, noise_m, made.gravity_m_s2);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    for (const LeastSd& least : all) {
      const std::optional<double> sd = least_sd_of(least, targets[t].quantity);
      if (!sd) continue;
      const double factor = targets[t].measure == Target::Measure::sd        ? 1.0
                            : targets[t].measure == Target::Measure::error95 ? core::kNormal95
                                                                             : 0.0;
      results[t].bound = std::max(results[t].bound.value_or(0.0), factor * *sd);
    }
  }
  return results;
}

double hardest(const std::vector<TargetResult>& results, const std::vector<Target>& targets) {
  double need = 0.0;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    need = std::max(need, results[t].bound ? *results[t].bound / targets[t].value : kNever);
  }
  return need;
}

std::vector<Limit> limits_of(const Setting& setting, double need, const std::vector<Target>& targets) {
  std::vector<Limit> limits;
  const auto try_without = [&](Limitation what, const Setting& changed, const WithoutLimit& without) {
    const double then = need_of(changed, without, targets);
    if (std::isfinite(then) && then > 0.0) limits.push_back({what, need / then});
  };
  if (setting.scenario.recording.frame_rate_hz < kFast_hz) {
    Setting fast = setting;
    fast.scenario.recording.frame_rate_hz = kFast_hz;
    fast.scenario.recording.clock.jitter_s = 0.0;  // it may exceed the time between these frames
    try_without(Limitation::frame_rate, fast, {});
  }
  if (!setting.given_noise_m) {
    try_without(Limitation::light, setting, {.shot_noise = true});
    try_without(Limitation::camera_noise, setting, {.camera_noise = true});
    try_without(Limitation::motion_blur, setting, {.motion_blur = true});
    try_without(Limitation::resolution, setting, {.finer = kFiner});
  }
  std::sort(limits.begin(), limits.end(), [](const Limit& a, const Limit& b) { return a.gain > b.gain; });
  return limits;
}

namespace {

/// Errors of one estimator in one quantity of one configuration, run by run; infinite if there is no answer.
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
void judge_errors(const std::vector<Errors>& all, const Target& target, double confidence, TargetResult& result) {
  result.unanswered.clear();
  for (const fit::Estimator& estimator : fit::judged_estimators()) {
    std::optional<ErrorMeasure> worst;
    std::set<std::size_t> without;  // numbers of runs
    for (const Errors& errors : all) {
      if (errors.estimator != estimator.name || errors.quantity != target.quantity) continue;
      for (std::size_t run = 0; run < errors.errors.size(); ++run) {
        if (!std::isfinite(errors.errors[run])) without.insert(run);
      }
      const ErrorMeasure measure = measure_errors(errors.errors, target, confidence);
      if (!worst || measure.value > worst->value) worst = measure;
    }
    if (!without.empty()) result.unanswered.push_back({std::string(estimator.name), without.size()});
    if (!worst || (result.found && *result.found <= worst->value)) continue;
    result.found = worst->value;
    result.found_sd = worst->sd;
    result.low = worst->low;
    result.high = worst->high;
    result.runs = worst->runs;
    result.beyond = worst->beyond;
    result.estimator = estimator.name;
  }
}

/// The verdict on one target or several: a single missed one decides.
Verdict verdict_of(const std::vector<TargetResult>& results, const std::vector<Target>& targets) {
  bool sure = true;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const TargetResult& result = results[t];
    if (!result.found || !std::isfinite(*result.found)) return Verdict::missed;
    if (result.low > targets[t].value) return Verdict::missed;
    sure = sure && result.high <= targets[t].value;
  }
  return sure ? Verdict::reached : Verdict::undecided;
}

}  // namespace

std::shared_ptr<const render::Stage> RecordedRuns::stage() {
  const std::lock_guard lock(drawing_);
  if (!stage_) stage_ = render::set_stage(setting_.scenario, 1, options_.watch);
  return stage_;
}

MadeTracks RecordedRuns::tracks_of(const Setting& setting, const MadeTracks& clean, std::uint64_t run,
                                   Confirm confirm) {
  const std::uint64_t seed = seed_of(sweep_, point_ * options_.runs + run);
  if (confirm == Confirm::clips) {
    FilmStudio studio(setting.scenario, seed, 1, stage(), [this](std::string_view, double) { options_.watch(); });
    return studio.film(setting.scenario, seed, 1,
                       setting.lens_known ? true_camera(setting.scenario.camera) : std::nullopt);
  }
  // Clips of one scenario have about the same noise: their rms is used.
  const std::vector<double> noise_m = noise_of(setting, clean.truth);
  double square = 0.0;
  for (const double noise : noise_m) square += noise * noise / static_cast<double>(noise_m.size());
  return with_noise(clean, std::sqrt(square), seed);
}

RecordedRuns::Outcome RecordedRuns::outcome_of(const Setting& setting, std::uint64_t run, Confirm confirm) {
  if (options_.before_run) options_.before_run();
  const MadeTracks clean = make_tracks(setting.scenario, seed_of(sweep_, point_ * options_.runs + run));
  const MadeTracks made = tracks_of(setting, clean, run, confirm);
  const auto analyze = [&](core::LineMethod lines) {
    return analyze_tracks(made, core::MotionOptions{.lines = lines});
  };
  Outcome outcome;
  for (const core::AnalysisResults& by : fit::estimate_each(fit::judged_estimators(), analyze)) {
    const auto quantities = compare_quantities(by, clean.truth);
    outcome.insert(outcome.end(), quantities.begin(), quantities.end());
  }
  return outcome;
}

void RecordedRuns::make(std::uint64_t number) {
  Run& run = done_.at(number);
  if (run.made) return;
  try {
    run.outcome = outcome_of(setting_, number, options_.confirm);
  } catch (const base::InputError&) {
    run.error = std::current_exception();
  } catch (const base::NumericalError&) {
    run.error = std::current_exception();
  }
  run.made = true;
}

std::vector<RecordedRuns::Outcome> RecordedRuns::outcomes_of(const Setting& setting, Confirm confirm,
                                                             std::uint64_t runs) {
  std::vector<Outcome> outcomes(runs);
  base::for_each_parallel(runs, options_.jobs,
                          [&](std::size_t run) { outcomes[run] = outcome_of(setting, run, confirm); });
  return outcomes;
}

namespace {

void judge_outcomes(const std::vector<std::vector<QuantityComparison>>& outcomes, const std::vector<Target>& targets,
                    double confidence, std::vector<TargetResult>& results) {
  std::vector<Errors> all;
  for (const std::vector<QuantityComparison>& outcome : outcomes) add_errors(outcome, all);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    results[t].found.reset();
    judge_errors(all, targets[t], confidence, results[t]);
  }
}

}  // namespace

Verdict RecordedRuns::judge(std::vector<TargetResult>& results, double confidence) const {
  std::vector<Outcome> outcomes;
  for (const Run& run : done_) {
    if (run.error) std::rethrow_exception(run.error);
    outcomes.push_back(run.outcome);
  }
  judge_outcomes(outcomes, options_.targets, confidence, results);
  return verdict_of(results, options_.targets);
}

Verdict RecordedRuns::judge_after(std::uint64_t runs, std::vector<TargetResult>& results, double confidence) {
  plan(runs);
  base::for_each_parallel(done_.size(), options_.jobs, [&](std::size_t run) { make(run); });
  return judge(results, confidence);
}

std::vector<Limit> RecordedRuns::limits() {
  std::vector<Limit> limits;
  const Setting& setting = setting_;
  const std::uint64_t runs = options_.confirm == Confirm::clips ? std::min(kLimitRuns, options_.runs) : planned();
  plan(runs);
  base::for_each_parallel(runs, options_.jobs, [&](std::size_t run) { make(run); });
  std::vector<Outcome> as_it_is;
  for (std::uint64_t run = 0; run < runs; ++run) {
    if (done_[run].error) return limits;
    as_it_is.push_back(done_[run].outcome);
  }
  std::vector<TargetResult> now(options_.targets.size());
  judge_outcomes(as_it_is, options_.targets, kConfidence, now);
  const auto try_without = [&](Limitation what, const Setting& changed, Confirm confirm) {
    std::vector<TargetResult> then(options_.targets.size());
    judge_outcomes(outcomes_of(changed, confirm, runs), options_.targets, kConfidence, then);
    double gain = 0.0;
    for (std::size_t t = 0; t < then.size(); ++t) {
      if (now[t].found && then[t].found) gain = std::max(gain, *now[t].found / *then[t].found);
    }
    if (std::isfinite(gain) && gain > 0.0) limits.push_back({what, gain});
  };
  Setting changed = setting;
  changed.scenario.recording.clock = {};
  try_without(Limitation::clock, changed, options_.confirm);
  if (options_.confirm != Confirm::clips) return limits;
  if (setting.scenario.recording.shutter.rolling) {
    changed = setting;
    changed.scenario.recording.shutter.rolling = false;
    try_without(Limitation::rolling_shutter, changed, options_.confirm);
  }
  if (render::lossy(setting.scenario.codec)) {
    changed = setting;
    changed.scenario.codec = render::Codec::magicyuv;
    try_without(Limitation::codec, changed, options_.confirm);
  }
  if (true_camera(setting.scenario.camera)) {
    changed = setting;
    changed.lens_known = true;
    try_without(Limitation::calibration, changed, options_.confirm);
  }
  try_without(Limitation::imaging, setting, Confirm::tracks);
  return limits;
}

}  // namespace glidelab::validate
