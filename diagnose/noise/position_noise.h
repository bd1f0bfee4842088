/// The noise of positions, measured: how much is white, how much neighbouring frames share (whitening.h), and how much
/// grows with the speed.
///
/// Restricted maximum likelihood finds the amplitudes and lengths that make the positions most likely once everything
/// slow is set aside, so that neither the nominal model nor its deficiencies enter. The residuals of a stretch are r =
/// B b + noise, with b arbitrary. B is what is set aside as slow: bumps ten frames apart (30 if the codec predicts
/// images from earlier ones, as its errors last for up to a dozen frames) and, if a wave shows, its sine and cosine and
/// what the fit made of it. Then
///
///     log L = sum over motions of  -f log s_i - q_i/(2 s_i²) - (log|V| + log|B' V^-1 B|)/2 - (log(s_i/s)/0.3)²/2
///
/// with V a stretch's covariance over s², q_i the sum of squares that is left under V^-1, and f their number minus the
/// number of columns of B. Each motion's white noise s_i is set to its most likely value; s_i scatter by some 30 %
/// about s, their mean. For a codec that predicts images from earlier ones, a prior for its errors is added. Lengths
/// are in pixels (unit_m() of whitening.h).
///
/// The pixels of imported tracks are unknown. Their noise may last for some frames, as with a tracker that follows its
/// own last image; it is taken as white unless the correlation shows beyond doubt. A correlation over four frames or
/// longer may be an effect that the model lacks, and does not count as noise.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <limits>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {

/// A stretch of positions from which the noise is measured, with the columns that are set aside as slow.
struct NoiseChunk {
  std::size_t motion = 0;
  SeenFrames frames;
  Eigen::MatrixXd slow;  ///< what is projected out: orthonormal columns
  Eigen::VectorXd off_px;
};

/// The stretches of all motions, chosen evenly if there are more than 1920 points. Left out are outliers, points eight
/// standard deviations off their neighbours, and stretches of fewer than 24 points. `wave_hz`: 0 for none.
std::vector<NoiseChunk> noise_chunks(const TrackSet& set, const MotionFit& fit, double wave_hz);

struct Likelihood {
  double value = -std::numeric_limits<double>::infinity();
  double white_px = 0.0;
  std::vector<double> own_px;  ///< s of each motion
};

/// How likely a shape of the noise of filmed positions (whitening.h) is: the restricted likelihood.
class NoiseLikelihood {
 public:
  /// `pilot_px`: approximately s, for the part of the covariance that has its own size. `handed_on`: the file's codec
  /// predicts images from earlier ones.
  NoiseLikelihood(std::vector<NoiseChunk> chunks, std::size_t motions, double pilot_px, bool handed_on);

  /// Log prior of the noise of such a file.
  double known(const NoiseShape& shape) const;

  /// The likelihood, prior included.
  Likelihood of(const NoiseShape& shape) const;

 private:
  /// The residuals of a motion under a shape: their squares over unit s, their number, log |V| and the like.
  struct Left {
    double square = 0.0, freedom = 0.0, logs = 0.0;
  };
  /// The same with one more stretch of the motion.
  Left with(const NoiseChunk& chunk, const NoiseShape& shape, Left left) const;

  std::vector<NoiseChunk> chunks_;
  std::size_t motions_;
  double pilot_px_;
  bool handed_on_;
};

/// Sets the noise of a set (position_noise) and of its motions (sd_m, wider, whitening). Returns false and changes
/// nothing if a filmed marker hardly moves, for tracks whose noise is white, or with fewer than 80 points.
bool find_position_noise(TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
