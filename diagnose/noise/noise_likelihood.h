/// How likely the noise of filmed positions has a shape (whitening.h): restricted likelihood.
///
///     log L = sum over motions of  -f log s_i - q_i/(2 s_i²) - (log|V| + log|B' V^-1 B|)/2 - (log(s_i/s)/0.3)²/2
///
/// V a stretch's covariance over s², B what is set aside as slow (noise_chunks.h), q_i the squares that are left under
/// V^-1, f their number less the columns of B; each motion's white noise s_i at its likeliest, some 30 % about s, their
/// mean. Of a codec that predicts images from those before, what is known of its errors is added.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "diagnose/noise/noise_chunks.h"

namespace glidelab::diagnose {

struct Likelihood {
  double value = -std::numeric_limits<double>::infinity();
  double white_px = 0.0;
  std::vector<double> own_px;  ///< s of each motion
};

class NoiseLikelihood {
 public:
  /// `pilot_px`: about s, for the part of the covariance that has a size of its own. `handed_on`: the file's codec
  /// predicts images from those before.
  NoiseLikelihood(std::vector<NoiseChunk> chunks, std::size_t motions, double pilot_px, bool handed_on);

  /// What is known beforehand of such a file's noise, as a log likelihood.
  double known(const NoiseShape& shape) const;

  /// With what is known beforehand.
  Likelihood of(const NoiseShape& shape) const;

 private:
  /// What is left of a motion under a shape: the residuals' square over unit s, their number, log |V| and the like.
  struct Left {
    double square = 0.0, freedom = 0.0, logs = 0.0;
  };
  /// One more stretch of it.
  Left with(const NoiseChunk& chunk, const NoiseShape& shape, Left left) const;

  std::vector<NoiseChunk> chunks_;
  std::size_t motions_;
  double pilot_px_;
  bool handed_on_;
};

}  // namespace glidelab::diagnose
