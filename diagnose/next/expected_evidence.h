/// How informative a change to the experiment would be, before it is made. In the linear neighbourhood of a fit, the
/// change's clip is simulated by the track model, with noise as in the clips so far (white, or according to
/// position_noise.h).
///
///     split = 1/2 u' (1 + G C G')^-1 u,        C' = C - C G' (1 + G C G')^-1 G C
///
/// u is what explanation A predicts for the new clip and the new statements minus what B predicts, over their noise; G
/// the derivatives of B by its common parameters, the clip's own start projected out; C their covariance so far.
/// `split` is the log likelihood that B is expected to lose if A is right.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/next/next_changes.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// Expected log likelihood that the change would cost `b` if `a` is right; 0 if the clip cannot be made (fewer than 12
/// positions, or a motion that runs away). `covariance_b` is common_covariance(b).
double expected_split(const TrackSet& set, const MotionFit& a, const MotionFit& b, const Eigen::MatrixXd& covariance_b,
                      const Change& change);

/// Covariance of a fit's common parameters after the change; `covariance` is that before it.
Eigen::MatrixXd expected_covariance(const TrackSet& set, const MotionFit& fit, const Eigen::MatrixXd& covariance,
                                    const Change& change);

}  // namespace glidelab::diagnose
