/// The noise that neighbouring frames of a clip share, as a covariance.
///
/// Where the marker moves slowly, several frames see it on the same pixels and share their errors. Of two frames i, j
/// of a motion, d their distance in the image along it (px), n in frames, v the speed, over the white noise s:
///
///     cov / s² = [i = j]                       photons, read noise, rounding
///              + a² exp(-(d/l)²/2)             pixels that differ from each other (PRNU), at the marker's edges
///              + b² cos(2 pi d) exp(-d/L)      the position between two pixels, new at positions some L away
///              + c² exp(-n/m)                  what a codec with loss, or a tracker, hands from frame to frame
///              + (v tau/s)² [i = j]            uneven times
///
/// The pixels of imported tracks are unknown: there the unit of d is the metre, and a = b = 0. Motions count as
/// independent of each other, and so do stretches of 240 points: it is ignored that clips pass over the same pixels.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// What the covariance of frames depends on.
struct SeenFrames {
  std::vector<double> along_px, frame, v_px_s;
};

/// Covariance over s² of all these frames; `white_px` is s, for the jitter.
Eigen::MatrixXd covariance_of(const SeenFrames& frames, const NoiseShape& shape, double white_px);

/// The length that "px" means for this motion, in metres: a pixel, or, if it was not filmed, the metre itself.
double unit_m(const TrackedMotion& motion);

/// The frames of a motion; `rate_hz` is that of its clip. Empty if a filmed marker hardly moves.
SeenFrames seen_frames(const TrackedMotion& motion, double rate_hz);

/// Sets `wider` and `whitening` for a motion whose sd_m (now s), outliers and along_px are set.
void whiten(TrackedMotion& motion, const NoiseShape& shape, double rate_hz);

/// Turns columns over each position's own noise (zero at outliers) into columns of unit white noise, and back. A motion
/// without whitening has white noise, apart from its remainder, which counts as noise.
Eigen::MatrixXd whitened(const TrackedMotion& motion, Eigen::MatrixXd over_sd);
Eigen::VectorXd coloured(const TrackedMotion& motion, Eigen::VectorXd white);

/// Columns whitened by the noise alone, without the remainder.
Eigen::MatrixXd without_remainder(const TrackedMotion& motion, Eigen::MatrixXd white);

/// Converts weights w' of sums over coloured noise to weights of the same sums over the underlying white noise.
Eigen::MatrixXd weights_of_white(const TrackedMotion& motion, Eigen::MatrixXd weights);

}  // namespace glidelab::diagnose
