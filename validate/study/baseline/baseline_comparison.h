/// Is the analysis worse than it was? Present errors compared with those of a baseline.
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
/// fails with at most the significance. With the same noise it would prove nothing: other_seed() of baseline.h.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "validate/study/baseline/baseline.h"

namespace glidelab::validate {

/// What became worse, in words with its numbers.
struct Worse {
  std::string configuration, estimator,
      quantity;      ///< of smoothing: the clip, the default estimator, "a" or "bandwidth"
  std::string what;  ///< "spread", "bias", "coverage", "answers"; "rms error", "mean"
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

/// InputError if the two are not of one scenario, noise and set of quantities.
BaselineComparison compare_baselines(const Baseline& then, const Baseline& now);

}  // namespace glidelab::validate
