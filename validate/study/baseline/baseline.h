/// Is the analysis worse than it was? Errors of replicated tracks of a scenario against those that were stored.
///
/// For each quantity of each configuration and estimator:
///
///     spread      Levene's test: Welch's t of |error - mean|, which stands heavy tails better than an F test does
///     bias        Welch's t of the mean errors                    |mean now| above |mean then|
///     coverage    test of two proportions (normal)                fewer values within 1.96 stated sd of the truth
///     answers     the same, of the runs that gave a value
///
/// and for the phase diagram of each clip, whose lines a correction makes insensitive to how they were smoothed:
///
///     a(t)        Welch's t of ln(root mean square error of the smoothed acceleration)
///     bandwidth   Welch's t of ln(bandwidth), in either direction: it has no better and worse
///
/// each one-sided (but for the bandwidth) at significance / number of tests (Bonferroni), so that an unchanged analysis
/// fails with at most the significance. With the same noise it would prove nothing: other_seed().
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "core/result/results.h"
#include "render/scenario/scenario.h"
#include "validate/tracks/made_tracks.h"

namespace glidelab::validate {

/// Errors of one quantity over the runs.
struct ErrorRecord {
  std::string configuration, estimator, quantity;
  std::uint64_t runs = 0;
  std::uint64_t answers = 0;
  std::uint64_t covered = 0;  ///< the truth lies within 1.96 stated sd
  double mean = 0.0;
  double sd = 0.0;
  double deviation = 0.0;     ///< mean of |error - mean|
  double deviation_sd = 0.0;  ///< standard deviation of |error - mean|
  double efficiency = 0.0;    ///< (Cramér-Rao bound / rms error)²; 0 where there is no bound
};

/// How the clips of the first estimator were smoothed, over the runs that have points which count.
struct SmoothingRecord {
  std::string clip;
  std::uint64_t runs = 0;
  double log_bandwidth = 0.0, log_bandwidth_sd = 0.0;  ///< of ln(h/s): mean, standard deviation
  double log_a_error = 0.0, log_a_error_sd = 0.0;      ///< of ln(rms error of a / (m/s²))
};

struct Baseline {
  std::string scenario;  ///< its text
  double noise_m = 0.0;
  std::uint64_t runs = 0;
  std::optional<std::uint64_t> seed = {};  ///< of the noise; files of versions before it have none
  std::vector<ErrorRecord> records;
  std::vector<SmoothingRecord> smoothing;
};

struct BaselineOptions {
  double noise_m = 2e-5;
  std::uint64_t runs = 100;
  std::uint64_t seed = 1;
  int jobs = 1;
};

/// All results of one run's tracks, one for each estimator.
using AnalyzeTracks = std::function<std::vector<core::AnalysisResults>(const MadeTracks&)>;

/// The phase diagram and the fit of the whole motion.
std::vector<core::AnalysisResults> analyze_both(const MadeTracks& made);

Baseline measure_baseline(const render::Scenario& scenario, const std::string& scenario_text,
                          const BaselineOptions& options, const AnalyzeTracks& analyze = analyze_both,
                          const base::Progress& progress = base::no_progress);

/// What became worse, in words with its numbers.
struct Worse {
  std::string configuration, estimator, quantity;  ///< of smoothing: the clip, "phase-diagram", "a" or "bandwidth"
  std::string what;                                ///< "spread", "bias", "coverage", "answers"; "rms error", "mean"
  double then = 0.0, now = 0.0;
  double p = 0.0;  ///< of one test, before the number of tests is counted
};

struct BaselineComparison {
  std::size_t tests = 0;
  double significance = 0.01;  ///< of all tests together
  double power_spread = 0.0;   ///< probability that errors 1.5 times as large are found, were they normal
  double power_bias = 0.0;     ///< that a bias of half a standard deviation is
  double power_doubled = 0.0;  ///< that a doubled bandwidth is, by the bandwidth, in the clip where it varies most
  std::vector<Worse> worse;
};

/// InputError where the two are not of one scenario, noise and set of quantities.
BaselineComparison compare_baselines(const Baseline& then, const Baseline& now);

/// Of other noise than the baseline's; of one that does not know its seed than that of the default, 1.
std::uint64_t other_seed(const Baseline& then);

std::string baseline_json(const Baseline& baseline);
/// InputError for what --write-baseline has not made, with the first key that is wrong.
Baseline read_baseline(const std::filesystem::path& file);

}  // namespace glidelab::validate
