/// Tracks and pictures weighed together: a log likelihood of its own for each effect that pictures can speak for or
/// against.
///
/// What the pictures show of an effect is independent of the positions' noise, so that logs add up. An effect that they
/// show joins every explanation of the tracks, named or not, without competing with it: light may flicker beside any
/// force. A camera that sways in the tracks must be seen to sway, by about as much, in what rests in the scene.
#pragma once

#include <set>

#include "diagnose/hypotheses.h"
#include "diagnose/picture_evidence.h"

namespace glidelab::diagnose {

/// `without` are effects that are not considered.
void join_pictures(const TrackSet& set, const PictureEvidence& pictures, const std::set<std::size_t>& without,
                   Comparison& comparison);

/// Log evidence that positions' noise is correlated over up to 16 frames, as a codec makes it, against white noise: an
/// exponential correlation beside a white part, both of free size, by a Kalman filter over the fit's residuals.
struct CorrelatedNoise {
  double gain = 0.0, log_evidence = 0.0;
  double share = 0.0, frames = 0.0;  ///< of the variance; how long it lasts
};
CorrelatedNoise scan_correlation(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
