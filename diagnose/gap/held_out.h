/// How far a model lies from data that it was not fitted to.
///
/// Each clip in turn is left out: the common parameters come from the other clips and from the statements, its own
/// start is fitted to it, and its residuals are standardised by their predictive covariance, that is the position noise
/// plus the uncertainty of the common parameters. The root mean square over all clips is 1 if the model is right. This
/// is done in the linear neighbourhood of the fit to all clips: a clip is taken out of the normal equations and one
/// Newton step is taken, which is exact if the model is linear in the fitted parameters. Whatever is found by a search
/// and not by steps comes from all clips: which of several waves or locations it is, which frames are lost, and the
/// shape and tau of a function without a name.
///
/// For a single clip, each motion is left out if there are three or more; otherwise quarters of each. Such a stretch
/// keeps the motion's own start and speed, which come from the rest of the motion: a start of its own would absorb the
/// effect of a wrong law within a quarter.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

struct ClipGap {
  std::string clip;
  double chi2 = 0.0;
  double freedom = 0.0;
  double acceleration_square = 0.0;  ///< sum of squares, (m/s²)²
  double acceleration_count = 0.0;   ///< number of squares in the sum
};

struct HeldOutGap {
  double value = 0.0;           ///< root mean square of the standardised residuals; 1 is the floor
  double standard_error = 0.0;  ///< of `value` if that is 1: sqrt(0.82/n), from the points and the noise's own
                                ///< uncertainty
  std::vector<ClipGap> clips;
  std::optional<double>
      acceleration_m_s2;  ///< rms of a(real) - a(model), both smoothed as the analysis does, noise included
};

HeldOutGap held_out_gap(const TrackSet& set, const MotionFit& fit);

/// A single clip as four stretches that count as separate clips, each with its own start.
TrackSet split_clip(const TrackSet& set);

/// Covariance of the common parameters, from positions and statements.
Eigen::MatrixXd common_covariance(const MotionFit& fit);

/// The fit at the minimum of its linear neighbourhood: its parameters and residuals (`residual`, `plain`) are updated;
/// speeds, derivatives and cost stay as they are.
MotionFit at_linear_minimum(const TrackSet& set, MotionFit fit);

/// How far a statement lies from the result of all other data, in standard deviations of the difference: z = (stated -
/// fitted) / sqrt(sd² - C), C the fitted angle's variance. The result of all other data is the fit with the statement
/// removed again: (fitted sd² - stated C)/(sd² - C) ± sd sqrt(C/(sd² - C)). The fit must be at its minimum.
struct StatementPull {
  std::string quantity;  ///< "alpha_deg"
  Against against = Against::stated;
  std::string group;
  std::optional<double> z;  ///< none if all other data determine the angle a hundred times worse than the statement
  double stated_rad = 0.0, stated_sd_rad = 0.0;
  double else_rad = 0.0, else_sd_rad = 0.0;  ///< if there is a z
};
std::vector<StatementPull> statement_pulls(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
