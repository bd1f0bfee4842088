/// Tracks and images weighed together: a separate log likelihood for each effect that images can support or contradict.
///
/// The evidence of the images for an effect is independent of the noise of the positions, so the logarithms add. An
/// effect that the images show joins every explanation of the tracks, named or not, without competing with it: light
/// may flicker beside any force. A camera sway in the tracks must show in the static scene, with about the same size; a
/// line time that the tracks show must be the one that shears the marker.
#pragma once

#include <set>

#include "diagnose/pictures/image_evidence.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// `without` are effects that are not considered.
void join_images(const TrackSet& set, const ImageEvidence& images, const std::set<std::size_t>& without,
                 Comparison& comparison);

/// Log likelihood ratio of a size that images measured (0: absent): under the size that the tracks found, and under its
/// absence, both sizes with their standard deviations: log N(p; t, sp² + st²) - log N(p; 0, sp²).
struct Measured {
  double value = 0.0, sd = 0.0;
};
double agreement(const Measured& in_images, const Measured& in_tracks);

/// Log evidence that the noise of positions is correlated over up to 8 frames, as a codec makes it, against white
/// noise. The model is an exponential correlation plus a white part, both of free size, with a Kalman filter over the
/// fit's residuals.
struct CorrelatedNoise {
  double gain = 0.0, log_evidence = 0.0;
  double share = 0.0, frames = 0.0;  ///< its share of the variance; its correlation time
  double inflation = 1.0;            ///< variance of slow quantities under such noise, over that under white noise
};
CorrelatedNoise scan_correlation(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
