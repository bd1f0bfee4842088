/// A gate before an analysis or an estimator: replicated tracks of a scenario are analysed, and their errors compared
/// with those of a baseline. Is the analysis worse than it was, and how small a worsening would be detected?
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "fit/outside/outside_estimator.h"
#include "fit/outside/outside_tally.h"
#include "render/scenario/scenario.h"
#include "validate/study/baseline/baseline.h"

namespace glidelab::validate {

/// What became worse, in words and numbers.
struct Worse {
  std::string configuration, estimator,
      quantity;      ///< for smoothing: the clip, the default estimator, "a" or "bandwidth"
  std::string what;  ///< "spread", "bias", "coverage", "answers"; "rms error", "mean"
  double then = 0.0, now = 0.0;
  double p = 0.0;  ///< of one test, not corrected for the number of tests
};

struct BaselineComparison {
  std::size_t tests = 0;
  double significance = 0.01;  ///< of all tests together
  double power_spread = 0.0;   ///< probability of detecting errors 1.5 times as large, if they are normal
  double power_bias = 0.0;     ///< probability of detecting a bias of half a standard deviation
  double power_doubled = 0.0;  ///< probability of detecting a doubled bandwidth, by the bandwidth, in the clip where it
                               ///< varies most
  std::vector<Worse> worse;
};

/// Is the analysis worse than it was? InputError if the two do not have the same scenario, noise and set of quantities.
///
/// For each quantity of each configuration and estimator:
///
///     spread      Levene's test: Welch's t of |error - mean|, which tolerates heavy tails better than an F test
///     bias        Welch's t of the mean errors                    |mean now| above |mean then|
///     coverage    test of two proportions (normal)                fewer values within 1.96 stated sd of the truth
///     answers     the same, for the runs that gave a value
///
/// and for the phase diagram of each clip, whose lines are insensitive to the smoothing because of a correction:
///
///     a(t)        Welch's t of ln(root mean square error of the smoothed acceleration)
///     bandwidth   Welch's t of ln(bandwidth), in either direction: there is no better or worse
///
/// each one-sided (except for the bandwidth) at significance / number of tests (Bonferroni), so that an unchanged
/// analysis fails with at most the probability `significance`. With the same noise it would prove nothing: other_seed()
/// of baseline.h.
BaselineComparison compare_baselines(const Baseline& then, const Baseline& now);

/// With which a change is said to be detected.
inline constexpr double kDetectionProbability = 0.95;
/// A gate that detects only errors larger than this many times misses too much.
inline constexpr double kWeakFactor = 1.5;
/// What a good gate detects: errors this many times as large.
inline constexpr double kSmallFactor = 1.1;

/// The smallest worsening of one quantity that a comparison with a baseline detects.
struct Detectable {
  std::string configuration, estimator,
      quantity;                      ///< for smoothing: the clip, the default estimator, "a" or "bandwidth"
  std::optional<double> factor;      ///< errors this many times as large; empty if these runs detect no factor at all
  std::optional<double> bias;        ///< in the quantity's unit; empty for smoothing
  std::uint64_t runs_for_weak = 0;   ///< number of runs, then and now, needed to detect a factor of kWeakFactor
  std::uint64_t runs_for_small = 0;  ///< the same for kSmallFactor
  bool weak() const { return !factor || *factor > kWeakFactor; }
};

/// One entry for each quantity and clip with two or more values on both sides. `comparison` must be of the same two
/// baselines.
///
/// For each test at its own level: the change that it detects with probability kDetectionProbability, from the spread
/// of the baseline itself and normal quantiles z:
///
///     errors f times as large   (f - 1) d = (z_level + z_found) s sqrt(f²/n + 1/m)
///     a mean error farther off  b = (z_level + z_found) sd sqrt(1/n + 1/m)
///     a(t), bandwidth           ln f = (z_level + z_found) sd_of_ln sqrt(1/n + 1/m)
///
/// with d and s the mean and the standard deviation of |error - mean|, n values now and m then.
std::vector<Detectable> detectable(const Baseline& then, const Baseline& now, const BaselineComparison& comparison);

struct GateOptions {
  std::filesystem::path baseline;          ///< the file to compare with; empty: nothing is compared
  std::optional<double> noise_m = {};      ///< empty: the baseline's; without one BaselineOptions::noise_m
  std::optional<std::uint64_t> seed = {};  ///< empty: another one than the baseline's; without one 1
  std::uint64_t runs = 100;
  int jobs = 1;
  std::optional<fit::OutsideEstimator> outside = {};  ///< judged alone; without one all of fit::judged_estimators()
};

struct Gate {
  Baseline now;
  std::optional<Baseline> then = {};                  ///< the baseline
  std::optional<BaselineComparison> comparison = {};  ///< of compared()
  std::vector<Detectable> detectable = {};
  std::optional<fit::OutsideTally> outside = {};
};

/// Measures the errors; they are not compared yet, so that they can be kept whatever the comparison says. `text` is the
/// scenario's, `file` its name in messages. InputError for a baseline of another scenario or noise, and for its own
/// seed; as in read_baseline().
Gate run_gate(const render::Scenario& scenario, const std::string& text, const std::string& file,
              const GateOptions& options, const base::Progress& progress = base::no_progress);

/// The same with the comparison, if there is a baseline. InputError as in compare_baselines().
Gate compared(Gate gate);

}  // namespace glidelab::validate
