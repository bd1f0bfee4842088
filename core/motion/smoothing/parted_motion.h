/// The positions of one input as chains (wiener_chain.h): its parts, the breaks of each, and the process over all.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

#include "core/motion/smoothing/smoother.h"
#include "core/motion/smoothing/wiener_chain.h"

namespace glidelab::core {

/// One part with its own breaks and the requested times within it.
struct SmoothedPart {
  SeriesPart points;
  std::vector<double> breaks_s;
  std::vector<double> at_s;
  std::size_t first_at = 0;  ///< index of its first at_s in the input
};

/// The parts of an input that have kFewestSmoothed positions. The input is kept by reference.
struct MotionParts {
  explicit MotionParts(const SmoothingInput& of);

  bool breaks() const;
  /// Whether every side of the part's breaks has kFewestSmoothed positions.
  bool breaks_stand(const SmoothedPart& part) const;

  const SmoothingInput& input;
  std::vector<SmoothedPart> parts;
  double step_s = 0.0;     ///< the mean one
  double longest_s = 0.0;  ///< part
  double range_m = 0.0;    ///< of all positions
  double points = 0.0;     ///< number of points in all parts
};

/// How the motion is smoothed by a process of one order.
struct Smoothness {
  double tau_s = 0.0;     ///< (s^2 dt / q)^(1 / 2N)
  double rate_1_s = 0.0;  ///< k
  double jump_1_s2 = std::numeric_limits<double>::infinity();
};

/// Sums over all points of the smoothed motion.
struct SmoothedSums {
  double squares_m2 = 0.0, points = 0.0, trace = 0.0;
  double noise_variance() const { return squares_m2 / (points - trace); }
};

template <int N>
class PartedMotion {
 public:
  explicit PartedMotion(const MotionParts& parts);

  const MotionParts& parts() const { return parts_; }
  /// s^2, as stated or of maximum likelihood.
  double noise_variance(const ChainFit& fit) const;
  ChainFit fit(const Smoothness& how) const;
  /// -2 log of the marginal likelihood. The unknowns at a part's start, and at a break with a free jump, count as
  /// normal with the standard deviation kSize range d! / longest^d for derivative d, so that orders can be compared; x
  /// and v have flat priors.
  double minus_two_log_likelihood(const Smoothness& how) const;
  std::vector<ChainPosterior<N>> posteriors(const Smoothness& how) const;

 private:
  WienerRatio ratio(const Smoothness& how) const;

  const MotionParts& parts_;
  std::vector<WienerChain<N>> chains_;
  double least_variance_ = 0.0;
};

template <int N>
SmoothedSums sums_of(const std::vector<ChainPosterior<N>>& posteriors, const MotionParts& parts);

/// Moves each break to the nearest time at which the smoothed v is 0; returns the largest displacement.
template <int N>
double refine_breaks(const std::vector<ChainPosterior<N>>& posteriors, MotionParts& parts);

}  // namespace glidelab::core
