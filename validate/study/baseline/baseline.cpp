#include "validate/study/baseline/baseline.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "core/math/quantile.h"
#include "fit/estimators.h"
#include "validate/tracks/oracle_bandwidth.h"
#include "validate/truth/comparison.h"
#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {
namespace {

std::pair<double, double> mean_and_sd(const std::vector<double>& values) {
  if (values.empty()) return {0.0, 0.0};
  const double n = static_cast<double>(values.size());
  double sum = 0.0, square = 0.0;
  for (const double value : values) sum += value;
  for (const double value : values) square += (value - sum / n) * (value - sum / n);
  return {sum / n, values.size() > 1 ? std::sqrt(square / (n - 1.0)) : 0.0};
}

std::vector<ErrorRecord> records_of(const std::vector<std::vector<QuantityComparison>>& runs) {
  std::vector<ErrorRecord> records;
  for (std::size_t i = 0; i < runs.front().size(); ++i) {
    if (!runs.front()[i].truth) continue;
    const QuantityComparison& first = runs.front()[i];
    ErrorRecord record;
    record.configuration = first.configuration;
    record.estimator = first.estimator;
    record.quantity = first.quantity;
    record.runs = runs.size();
    std::vector<double> errors, deviations;
    double square = 0.0;
    for (const auto& run : runs) {
      const QuantityComparison& q = run.at(i);
      if (!q.error) continue;
      if (q.sd && std::abs(*q.error) <= core::kNormal95 * *q.sd) ++record.covered;
      errors.push_back(*q.error);
      square += *q.error * *q.error;
    }
    record.answers = errors.size();
    std::tie(record.mean, record.sd) = mean_and_sd(errors);
    for (const double error : errors) deviations.push_back(std::abs(error - record.mean));
    std::tie(record.deviation, record.deviation_sd) = mean_and_sd(deviations);
    if (first.cramer_rao_sd && square > 0.0) {
      record.efficiency = std::pow(*first.cramer_rao_sd, 2) / (square / static_cast<double>(record.answers));
    }
    records.push_back(std::move(record));
  }
  return records;
}

/// Logarithms of what one run's smoothing did to a clip.
struct Smoothed {
  double log_bandwidth, log_a_error;
};

std::vector<SmoothingRecord> smoothing_of(const Truth& truth,
                                          const std::vector<std::vector<std::optional<Smoothed>>>& runs) {
  std::vector<SmoothingRecord> records;
  for (std::size_t clip = 0; clip < truth.clips.size(); ++clip) {
    std::vector<double> bandwidths, errors;
    for (const auto& run : runs) {
      if (!run.at(clip)) continue;
      bandwidths.push_back(run[clip]->log_bandwidth);
      errors.push_back(run[clip]->log_a_error);
    }
    SmoothingRecord record;
    record.clip = truth.clips[clip].name;
    record.runs = bandwidths.size();
    std::tie(record.log_bandwidth, record.log_bandwidth_sd) = mean_and_sd(bandwidths);
    std::tie(record.log_a_error, record.log_a_error_sd) = mean_and_sd(errors);
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<std::optional<Smoothed>> smoothed_clips(const core::AnalysisResults& results, const Truth& truth) {
  std::vector<std::optional<Smoothed>> clips;
  for (std::size_t clip = 0; clip < truth.clips.size(); ++clip) {
    const core::ClipResult& of = results.clips.at(clip);
    const std::optional<double> error = acceleration_error_m_s2(of, truth.clips[clip]);
    const bool counts = error && *error > 0.0 && of.bandwidth_s > 0.0;
    clips.push_back(counts ? std::optional(Smoothed{std::log(of.bandwidth_s), std::log(*error)}) : std::nullopt);
  }
  return clips;
}

}  // namespace

std::vector<core::AnalysisResults> analyze_as_judged(const MadeTracks& made) {
  return fit::estimate_each(fit::judged_estimators(), [&](core::LineMethod lines) {
    return analyze_tracks(made, core::MotionOptions{.lines = lines});
  });
}

Baseline measure_baseline(const render::Scenario& scenario, const std::string& scenario_text,
                          const BaselineOptions& options, const AnalyzeTracks& analyze,
                          const base::Progress& progress) {
  Baseline baseline{scenario_text, options.noise_m, options.runs, options.seed, {}, {}};
  const MadeTracks clean = make_tracks(scenario, options.seed);
  const std::vector<LeastSd> bounds =
      least_sds(clean.truth, std::vector<double>(clean.tracks.size(), options.noise_m), clean.gravity_m_s2);
  std::vector<std::vector<QuantityComparison>> runs(options.runs);
  std::vector<std::vector<std::optional<Smoothed>>> smoothed(options.runs);
  std::atomic<std::uint64_t> done = 0;
  base::for_each_parallel(options.runs, options.jobs, [&](std::size_t run) {
    const MadeTracks made = with_noise(clean, options.noise_m, options.seed * 1000003u + run);
    const std::vector<core::AnalysisResults> all = analyze(made);
    smoothed[run] = smoothed_clips(all.front(), made.truth);
    for (const core::AnalysisResults& results : all) {
      for (QuantityComparison& q : with_bounds(compare_quantities(results, made.truth), bounds)) {
        runs[run].push_back(std::move(q));
      }
    }
    progress("runs", static_cast<double>(++done) / static_cast<double>(options.runs));
  });
  baseline.records = records_of(runs);
  baseline.smoothing = smoothing_of(clean.truth, smoothed);
  return baseline;
}

std::uint64_t other_seed(const Baseline& then) {
  return then.seed.value_or(1) + 1;
}

}  // namespace glidelab::validate
