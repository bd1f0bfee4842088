/// How far a model lies from data that it was not fitted to.
///
/// Each clip in turn is left out: the common parameters come from the other clips and from the statements, its own
/// start is fitted to it, and its residuals are standardised by their predictive covariance, the position noise and
/// what the uncertainty of the common parameters adds. The root mean square over all clips is 1 where the model is
/// right. In the linear neighbourhood of the fit to all clips: a clip is taken out of its normal equations and one step
/// of Newton's taken, which is exact where the model is linear in what is fitted. What is found by a search and not by
/// steps comes from all clips: which of several waves or places it is, which frames are lost, and the shape and tau of
/// a function without a name.
///
/// Of a single clip each motion is left out, where there are three or more, or else quarters of each. Such a stretch
/// keeps the motion's own start and speed, which come from the rest of the motion: a start of its own would take up
/// what a wrong law does within a quarter.
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
  double acceleration_count = 0.0;   ///< of so many
};

struct HeldOutGap {
  double value = 0.0;           ///< root mean square of the standardised residuals; 1 is the floor
  double standard_error = 0.0;  ///< of it, where it is 1: sqrt(0.82/n), from the points and the noise's own uncertainty
  std::vector<ClipGap> clips;
  std::optional<double>
      acceleration_m_s2;  ///< rms of a(real) - a(model), both smoothed as the analysis does, noise included
};

HeldOutGap held_out_gap(const TrackSet& set, const MotionFit& fit);

/// A single clip as four stretches that count as separate clips, each with a start of its own.
TrackSet split_clip(const TrackSet& set);

/// Covariance of the common parameters: positions and statements.
Eigen::MatrixXd common_covariance(const MotionFit& fit);

/// The fit at the minimum of its linear neighbourhood: its point, and what that leaves of the positions (`residual`,
/// `plain`); speeds, derivatives and cost stay as they are.
MotionFit at_linear_minimum(const TrackSet& set, MotionFit fit);

/// How far a statement lies from what everything else says, in standard deviations of the difference: z = (stated -
/// fitted) / sqrt(sd² - C), C the fitted angle's variance. What everything else says is the fit with the statement
/// removed again: (fitted sd² - stated C)/(sd² - C) ± sd sqrt(C/(sd² - C)). Of a fit that is at its minimum.
struct StatementPull {
  std::string quantity;  ///< "alpha_deg"
  std::string against;   ///< "plumb", "stated"
  std::string group;
  std::optional<double> z;  ///< none where everything else knows the angle a hundred times worse than the statement
  double stated_rad = 0.0, stated_sd_rad = 0.0;
  double else_rad = 0.0, else_sd_rad = 0.0;  ///< where there is a z
};
std::vector<StatementPull> statement_pulls(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
