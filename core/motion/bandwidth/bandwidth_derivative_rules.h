/// Bandwidth rules that aim at a = x'' (bandwidth_rule.h).
#pragma once

#include "core/motion/bandwidth/bandwidth_rule.h"

namespace glidelab::core {

/// Fan and Gijbels 1995 (J. R. Stat. Soc. B 57, 371): the least of the mean over points of
///
///     RSC(t; h) = s^2(t) (1 + 4 V),   s^2(t) = sum K_i r_i^2 / tr(K - K X (X'KX)^-1 X'K),   V = sum w_i^2,
///
/// r the residuals of the local cubic about t, w its weights for x; then times 0.829 for a.
class ResidualSquares : public BandwidthRule {
 public:
  std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const override;
};

/// h^9 = 5 R_2 s^2 dt / mean(x''''^2), R_2 = 3/(8 sqrt(pi)) (kernel_constants.h): the least mean square error of a with
/// one h for all points. x'''' comes from one polynomial of order 6 through each part (order p + 3: Fan and Gijbels
/// 1996, section 4.2; Ruppert, Sheather and Wand 1995 take it in blocks), the noise's share of its square is taken off.
/// Where x'''' does not stand out of the noise by two standard deviations of its mean square, the widest bandwidth is
/// taken, and the method says so. Correlated noise counts by its sum over all lags.
class PlugIn : public BandwidthRule {
 public:
  std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const override;
};

/// Ruppert 1997 (J. Am. Stat. Assoc. 92, 1049): at each point the estimates a(t; h) of nine neighbouring bandwidths are
/// fitted by c_0 + c_1 h^2; c_1 h^2 is the bias at h, and the mean over points of variance + bias^2 is made least. The
/// variance is exact for the noise as estimated, correlated or not.
class EmpiricalBias : public BandwidthRule {
 public:
  std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const override;
};

inline constexpr double kIciWidth = 1.25;
/// Intersection of confidence intervals (Goldenshluger and Nemirovski 1997; Katkovnik 1999): at each point the widest h
/// for which all a(t; h') ± kIciWidth sd(h'), h' <= h, have a value in common. Local: h varies along the motion. Theory
/// gives the width's order, not its value: with bias ~ h^2 and sd ~ h^-2.5 (their ratio at the best h is
/// sqrt(5)/2) the intervals, their noise apart, part at the best h for a width of 0.17, and at 1.6 times it for 1.25;
/// but narrow ones part by chance long before. 1.25 was chosen on a glider that slows down
/// (tests/core/test_bandwidth_rule.cpp), and serves other motions there.
class IntersectionOfIntervals : public BandwidthRule {
 public:
  std::optional<BandwidthPick> choose(const BandwidthProblem& problem) const override;
};

}  // namespace glidelab::core
