/// Tracks and images weighed together: a log likelihood of its own for each effect that images can speak for or
/// against.
///
/// What the images show of an effect is independent of the noise of the positions, so the logarithms add. An effect
/// that they show joins every explanation of the tracks, named or not, without competing with it: light may flicker
/// beside any force. A camera that sways in the tracks must be seen to sway, by about as much, in the static scene; a
/// line time that tracks show must be the one that shears the marker.
#pragma once

#include <set>

#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// `without` are effects that are not considered.
void join_pictures(const TrackSet& set, const PictureEvidence& pictures, const std::set<std::size_t>& without,
                   Comparison& comparison);

/// Log likelihood of a size that images measured (0: absent) under the one that tracks found, both with their
/// standard deviations, over that under its absence: log N(p; t, sp² + st²) - log N(p; 0, sp²).
struct Measured {
  double value = 0.0, sd = 0.0;
};
double agreement(const Measured& in_pictures, const Measured& in_tracks);

/// Log evidence that positions' noise is correlated over up to 8 frames, as a codec makes it, against white noise: an
/// exponential correlation beside a white part, both of free size, by a Kalman filter over the fit's residuals.
struct CorrelatedNoise {
  double gain = 0.0, log_evidence = 0.0;
  double share = 0.0, frames = 0.0;  ///< of the variance; how long it lasts
  double inflation = 1.0;            ///< variance of slow quantities under such noise, over that under white noise
};
CorrelatedNoise scan_correlation(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
