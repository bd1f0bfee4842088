/// The scatter of single positions about a smooth curve, and how it grows with the speed.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// For all points of a motion, including outliers.
struct Leftover {
  std::vector<double> over_sd;  ///< each over its own noise, corrected for the white noise that this number of bumps
                                ///< absorbs
  std::vector<double> v_m_s;    ///< modelled
};

/// What remains of a motion's residuals after a smooth curve: the scatter of single positions, regardless of any force
/// that the model lacks.
///
/// The curve is a least-squares sum of Gaussian bumps, as fine as needed until the errors of neighbours no longer
/// correlate. If the law is wrong by hundreds of standard deviations, a coarse curve has an error of its own,
/// especially at the clip's ends.
Leftover leftover_of(const TrackSet& set, const MotionFit& fit, std::size_t motion);

/// Residuals of single positions with their speeds.
struct SpeedScatter {
  std::vector<double> squares;  ///< over the motion's sd_m
  std::vector<double> fast;     ///< (v / sd_m)², 1/s²
  double top_m_s = 0.0;
  double widest = 1.0;

  /// `over_sd` is over the point's own noise.
  void add(const TrackedMotion& motion, std::size_t point, double over_sd, double v_m_s);
  void add(const SpeedScatter& of_a_motion);
};

/// Position noise that grows with the speed, as timing jitter tau causes it: variance sd² + (v tau)².
struct SpeedNoise {
  double gain = 0.0, log_evidence = 0.0;  ///< against the same noise at all speeds
  double jitter_s = 0.0, sd_s = 0.0;
};

/// `independent` is the share of the residuals that counts as independent. Nothing is found in fewer than 50.
SpeedNoise find_speed_noise(const TrackSet& set, const SpeedScatter& scatter, double independent);

/// If the scatter of positions about their neighbours (no model is involved) grows with the speed beyond doubt, each
/// position gets the noise of its speed, so that no force is fitted to the scatter of the fast ones. `late` as in the
/// fit; empty: no delay. Returns false if it does not.
bool give_fast_positions_their_noise(TrackSet& set, const Lateness& late);

}  // namespace glidelab::diagnose
