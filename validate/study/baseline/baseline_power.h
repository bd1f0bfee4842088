/// How small a worsening a comparison with a baseline (baseline_comparison.h) still detects, quantity by quantity.
///
/// Of each test at the level that it is made at, the change that it finds with probability kDetectionProbability, from
/// the spread that the baseline itself has and normal quantiles z:
///
///     errors f times as large   (f - 1) d = (z_level + z_found) s sqrt(f²/n + 1/m)
///     a mean error farther off  b = (z_level + z_found) sd sqrt(1/n + 1/m)
///     a(t), bandwidth           ln f = (z_level + z_found) sd_of_ln sqrt(1/n + 1/m)
///
/// with d and s the mean and the standard deviation of |error - mean|, n values now and m then.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "validate/study/baseline/baseline_comparison.h"

namespace glidelab::validate {

inline constexpr double kDetectionProbability = 0.9;
/// A gate that detects only errors larger than this many times misses too much.
inline constexpr double kWeakFactor = 1.5;

struct Detectable {
  std::string configuration, estimator,
      quantity;                     ///< of smoothing: the clip, the default estimator, "a" or "bandwidth"
  std::optional<double> factor;     ///< errors as many times as large; nothing if these runs find no factor at all
  std::optional<double> bias;       ///< in the quantity's unit; of smoothing none
  std::uint64_t runs_for_weak = 0;  ///< then and now, with which a factor of kWeakFactor would be found
  bool weak() const { return !factor || *factor > kWeakFactor; }
};

/// One for each quantity and clip with two values or more on both sides. `comparison`: of the same two.
std::vector<Detectable> detectable(const Baseline& then, const Baseline& now, const BaselineComparison& comparison);

}  // namespace glidelab::validate
