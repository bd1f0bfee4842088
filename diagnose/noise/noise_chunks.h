/// Stretches of positions from which the noise is measured, and what of them is set aside as slow.
///
/// A stretch's residuals are r = B b + noise, b anything: B has bumps ten frames apart (30 where a codec makes images
/// out of those before, whose errors last for up to a dozen frames), and, beside a wave, its sine and cosine and what
/// the fit made of it. Pixels (whitening.h: unit_m).
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {

struct NoiseChunk {
  std::size_t motion = 0;
  SeenFrames frames;
  Eigen::MatrixXd slow;  ///< what is projected out: orthonormal columns
  Eigen::VectorXd off_px;
};

/// Of all motions, evenly chosen where there are more than 1920 points. Outliers, and what is eight standard
/// deviations off its neighbours, are left out, and so is a stretch of fewer than 24 points. `wave_hz`: 0 for none.
std::vector<NoiseChunk> noise_chunks(const TrackSet& set, const MotionFit& fit, double wave_hz);

}  // namespace glidelab::diagnose
