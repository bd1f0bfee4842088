/// Scans for effects with a time of their own, a wave or a push, and the form in which every scan states its result.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit_neighbourhood.h"

namespace glidelab::diagnose {

/// One tried value of the second parameter; no value for an effect without a second parameter.
struct TriedShape {
  std::vector<double> values;
  ScoreColumn column;                ///< derivative with respect to the first parameter
  double square = 0.0, score = 0.0;  ///< its square and its product with the residuals, both after projection
};

/// The result of the search for one effect.
struct EffectScan {
  std::size_t effect = 0;
  bool visible = false;                  ///< whether the largest allowed size would show in these data
  double gain = 0.0;                     ///< gain in log likelihood at the best size, by the linear estimate
  double log_evidence = 0.0;             ///< relative to the fit itself, averaged over the prior
  double least_seen = 0.0;               ///< standard deviation of the first parameter
  std::vector<double> values;            ///< of the common parameters, from which to start a fit
  std::vector<std::vector<double>> own;  ///< of the parameters of each motion's own
  ScoreColumn direction;                 ///< derivative with respect to the first parameter, at the best shape
  std::vector<TriedShape> shapes;        ///< all shapes at which the effect would show
};

/// The best wave in time, as a displacement: one amplitude and one frequency for all motions and a free phase in each.
/// f_hz is 0 if there is no wave.
struct Wave {
  double gain = 0.0, log_evidence = 0.0, size_m = 0.0, f_hz = 0.0;
};

/// How much of the residuals of a fit a wave would explain, over the frequencies of range_of(). The evidence is
/// averaged over amplitudes (three decades), frequencies and phases. This is the slowest of all scans, and its result
/// serves every effect that is a wave.
Wave find_wave(const ScoreSpace& space);

/// That wave as an effect: the sway of a camera, or the acceleration of a shaking base that displaces the glider by
/// this wave.
EffectScan scan_waves(const ScoreSpace& space, std::size_t effect, const Wave& wave);

/// A hand that pushes at the start of the clips until one time, common to all: a size in each motion that begins with
/// its clip.
///
/// With prior probability 0.9 it is one hand. Its pushes have a common part along the motions, and each deviates from
/// it with half the standard deviation of that part. All of them act along the motions or, with probability 0.1, all
/// against them. Otherwise the pushes have any size and sign. The evidence is averaged over both cases, over the sizes
/// and over the time.
EffectScan scan_pushes(const ScoreSpace& space, std::size_t effect);

}  // namespace glidelab::diagnose
