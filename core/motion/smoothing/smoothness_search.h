/// The size tau and the rate k of the process by marginal likelihood (parted_motion.h): k for each tau, and the
/// posterior of both.
///
/// Prior: log tau is flat from 0.3 steps to half the longest part, and k over a width of kRateWidth / longest part. At
/// half the part and above, all tau are equivalent: the motion is an exact one of the process without noise.
#pragma once

#include <cmath>
#include <vector>

#include "core/motion/smoothing/parted_motion.h"

namespace glidelab::core {

/// The most likely k at one tau.
struct AtTau {
  Smoothness how;
  double rate_sd_1_s = 0.0;    ///< of k, which is nearly normal; 0 if there is no rate
  double minus_two_log = 0.0;  ///< for the posterior of tau, with k integrated out
};

enum class Rate { none, any };

/// The most likely k (or none) for taus that rise by a factor of 1.5, starting from the best tau for k = 0. `others`:
/// rates that may be near the most likely one.
template <int N>
std::vector<AtTau> along_tau(const PartedMotion<N>& motion, double jump_1_s2, Rate rate,
                             const std::vector<double>& others);

/// The same at one more tau, from a neighbour's.
template <int N>
AtTau at_tau(const PartedMotion<N>& motion, double tau_s, const AtTau& neighbour);

/// The most probable tau near a given one.
template <int N>
AtTau refined(const PartedMotion<N>& motion, const AtTau& near);

/// The most likely standard deviation of the jumps of a, with its tau and k.
template <int N>
AtTau with_jump(const PartedMotion<N>& motion, AtTau near);

/// The step of spread(), in standard deviations of log tau.
inline constexpr double kStepOfSpread = 0.8;

/// Points of a sum over tau, from the most probable one to both sides as far as they contribute; their weights follow
/// from `minus_two_log`.
template <int N>
std::vector<AtTau> spread(const PartedMotion<N>& motion, const AtTau& best);

/// The motion without process noise, which is a priori as probable as all taus together.
template <int N>
AtTau exact(const PartedMotion<N>& motion, const AtTau& best);

inline const AtTau& likeliest(const std::vector<AtTau>& all) {
  const AtTau* best = &all.front();
  for (const AtTau& one : all) {
    if (one.minus_two_log < best->minus_two_log) best = &one;
  }
  return *best;
}

}  // namespace glidelab::core
