#include "validate/study/sweep/one_run.h"

#include <algorithm>

#include "base/errors.h"
#include "core/result/quantity.h"
#include "fit/estimators.h"
#include "validate/film/film_studio.h"
#include "validate/made_tracks/oracle_bandwidth.h"
#include "validate/made_tracks/outside_runs.h"
#include "validate/study/coverage/naive_lines.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"
#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {
namespace {

QuantityRow row_of(std::string_view quantity, const std::optional<double>& truth, const core::Quantity& found,
                   const std::optional<double>& least_sd) {
  QuantityRow row;
  row.quantity = quantity;
  row.truth = truth;
  row.least_sd = least_sd;
  row.why = found.why;
  if (!found.estimate) return row;
  row.value = found.estimate->value;
  row.sd = found.estimate->sd;
  row.low95 = found.estimate->low95;
  row.high95 = found.estimate->high95;
  if (found.smoothing_correction) row.uncorrected = row.value.value() - *found.smoothing_correction;
  return row;
}

void add_quantities(const core::AnalysisResults& results, const Truth& truth, const std::vector<LeastSd>& least,
                    const std::string& estimator, std::vector<QuantityRow>& rows) {
  for (std::size_t c = 0; c < truth.configurations.size(); ++c) {
    const TrueConfiguration& expected = truth.configurations[c];
    const LeastSd bound = c < least.size() ? least[c] : LeastSd{};
    const auto found =
        std::find_if(results.configurations.begin(), results.configurations.end(), [&](const auto& result) {
          return std::find(result.clips.begin(), result.clips.end(), expected.clips.front()) != result.clips.end();
        });
    if (found == results.configurations.end()) continue;
    for (const core::QuantityName& quantity : core::kQuantities) {
      QuantityRow row = row_of(std::string(quantity.key), core::value_of(expected, quantity.which),
                               core::value_of(*found, quantity.which), core::value_of(bound, quantity.which));
      row.configuration = expected.name;
      row.estimator = estimator;
      rows.push_back(std::move(row));
    }
  }
}

void add_clips(const core::AnalysisResults& results, const Truth& truth, const std::string& estimator,
               std::vector<ClipRow>& rows) {
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    const core::ClipResult& clip = results.clips[c];
    ClipRow row{clip.name,     estimator,        clip.frames,
                clip.detected, clip.bandwidth_s, clip.position_noise_m,
                std::nullopt,  std::nullopt,     acceleration_error_m_s2(clip, truth.clips[c])};
    for (const core::LineFit& line : clip.segments) (line.direction < 0 ? row.r2_up : row.r2_down) = line.r2;
    rows.push_back(std::move(row));
  }
}

bool same_for_all_seeds(const render::ClockSetup& clock) {
  return clock.jitter_s == 0.0 && clock.dropped_fraction == 0.0 && clock.duplicated_fraction == 0.0;
}

}  // namespace

MadeTracks RunWorker::tracks_for(const RunRecord& record, const std::string& text, const render::Scenario& scenario) {
  if (!same_for_all_seeds(scenario.recording.clock)) return make_tracks(scenario, record.seed);
  if (made_of_ != text) {
    made_ = make_tracks(scenario, record.seed);
    made_of_ = text;
  }
  return made_;
}

FilmStudio& RunWorker::studio_for(const RunRecord& record, const std::string& text, const render::Scenario& scenario) {
  if (!studio_ || studio_point_ != record.point || studio_of_ != text) {
    studio_.reset();
    const std::uint64_t seed = seed_of(sweep_, record.point * sweep_.replicates);
    studio_ = std::make_unique<FilmStudio>(scenario, seed, 1, nullptr, progress_);
    studio_point_ = record.point;
    studio_of_ = text;
  }
  return *studio_;
}

std::shared_ptr<const render::Stage> RunWorker::stage_for(const RunRecord& record, const std::string& text,
                                                          const render::Scenario& scenario) {
  if (!stage_ || stage_point_ != record.point || stage_of_ != text) {
    stage_.reset();
    stage_ = render::set_stage(scenario, 1, [this] { progress_("stage", 0.0); });
    stage_point_ = record.point;
    stage_of_ = text;
  }
  return stage_;
}

void RunWorker::fill(RunRecord& record) {
  const RunScenario run = scenario_with(sweep_, record.values);
  MadeTracks made;
  std::vector<LeastSd> least;
  if (sweep_.level == Level::clips) {
    made = sweep_.calibrate_once
               ? studio_for(record, run.text, run.scenario).film(run.scenario, record.seed, 1)
               : film_tracks(run.scenario, record.seed, 1, progress_, stage_for(record, run.text, run.scenario));
  } else {
    const MadeTracks clean = tracks_for(record, run.text, run.scenario);
    made = with_noise(clean, run.noise_m, record.seed);
    if (run.noise_m > 0.0) {
      least = least_sds(clean.truth, std::vector<double>(clean.truth.clips.size(), run.noise_m), clean.gravity_m_s2);
    }
  }
  std::optional<core::AnalysisResults> by_default;  // the ordinary lines: several estimators start from them
  for (const Analysis& analysis : sweep_.analyses) {
    const fit::Estimator* const estimator = fit::find_estimator(analysis.estimator);  // null: all points
    const bool plain = !analysis.bandwidth_s && analysis.bandwidth_rule.empty();
    core::AnalysisResults results;
    if (estimator == nullptr) {
      results = lines_through_all_points(made, *analysis.bandwidth_s);
    } else if (analysis.bandwidth_rule == kBestPossible) {
      results = with_best_bandwidths(made);
    } else if (plain && estimator->lines == core::LineMethod::ordinary) {
      if (!by_default) by_default = analyze_tracks(made, core::MotionOptions{});
      results = estimator->estimate(*by_default, {});
    } else {
      const core::MotionOptions how{analysis.bandwidth_s, analysis.bandwidth_rule, estimator->lines};
      results = estimator->estimate(analyze_tracks(made, how), {});
    }
    if (estimator == nullptr || estimator->of_lines) add_clips(results, made.truth, analysis.name(), record.clips);
    add_quantities(results, made.truth, least, analysis.name(), record.quantities);
  }
  if (!sweep_.outside) return;
  const fit::OutsideOutcome outcome = run_outside_on_tracks(*sweep_.outside, made);
  add_quantities(outcome.results, made.truth, least, sweep_.outside->name, record.quantities);
}

RunRecord RunWorker::evaluate(std::uint64_t run) {
  RunRecord record;
  record.run = run;
  record.point = run / sweep_.replicates;
  record.replicate = run % sweep_.replicates;
  record.seed = seed_of(sweep_, run);
  record.values = values_of(sweep_, run);
  try {
    fill(record);
  } catch (const base::InputError& error) {
    record.failed = true;
    record.why = error.what();
  } catch (const base::NumericalError& error) {
    record.failed = true;
    record.why = error.what();
  }
  if (record.failed) {
    record.quantities.clear();
    record.clips.clear();
  }
  return record;
}

}  // namespace glidelab::validate
