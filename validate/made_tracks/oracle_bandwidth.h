/// The best bandwidth for a = x'' when the truth is known: the yardstick for the rules
/// (core/motion/bandwidth/bandwidth_rule.h).
///
///     h* = least of the mean over the points of  bias(t; h)^2 + variance(t; h)
///
/// with the bias from smoothing the true positions and the variance from the weights and the true noise, both exact;
/// no noise is drawn. Points within a tenth of the stretch of an end do not count, as in the rules.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/result/results.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::validate {

struct TrueStretch {
  std::span<const double> t_s;
  std::span<const double> x_m;
  std::span<const double> a_m_s2;
};

/// Mean square error of a at one bandwidth; nothing if a kernel holds too few points.
std::optional<double> true_error(const std::vector<TrueStretch>& stretches, const std::vector<double>& autocovariance,
                                 double bandwidth_s);

struct OracleBandwidth {
  double bandwidth_s = 0.0;
  double mean_square_m2_s4 = 0.0;
};

/// Searched from 1.2 median time steps to a fifth of the longest stretch, to one part in 1000.
std::optional<OracleBandwidth> best_bandwidth(const std::vector<TrueStretch>& stretches,
                                              const std::vector<double>& autocovariance);

/// The phase diagram in which every clip has its best bandwidth, for the stretches found and the noise estimated by an
/// analysis. NumericalError if a clip has none.
core::AnalysisResults with_best_bandwidths(const MadeTracks& made);

/// RMS of the smoothed acceleration minus the true one over the points that count in this clip; empty if none counts.
/// The clip's frames must be those of the truth.
std::optional<double> acceleration_error_m_s2(const core::ClipResult& clip, const TrueClip& truth);

}  // namespace glidelab::validate
