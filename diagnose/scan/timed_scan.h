/// The scans for effects with a time of their own, a wave or a push, and the form in which every scan states its
/// result.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit_neighbourhood.h"

namespace glidelab::diagnose {

/// One value of the second parameter that was tried (none of an effect without one).
struct TriedShape {
  std::vector<double> values;
  ScoreColumn column;                ///< what the first parameter changes,
  double square = 0.0, score = 0.0;  ///< what is left of it, squared, and its product with what the fit leaves
};

/// The result of the search for one effect.
struct EffectScan {
  std::size_t effect = 0;
  bool visible = false;                  ///< the largest size allowed would show in these data
  double gain = 0.0;                     ///< log likelihood gained at the best, linear estimate
  double log_evidence = 0.0;             ///< against the fit itself, prior sizes averaged over
  double least_seen = 0.0;               ///< size of one standard deviation (of the first parameter)
  std::vector<double> values;            ///< of the parameters that are common, where to begin a fit
  std::vector<std::vector<double>> own;  ///< of each motion's own ones
  ScoreColumn direction;                 ///< what it changes, at its best shape
  std::vector<TriedShape> shapes;        ///< all that would show
};

/// A wave in time, one amplitude and one frequency for all motions and a free phase in each: the best of all, as a
/// displacement. f_hz is 0 where there is no wave.
struct Wave {
  double gain = 0.0, log_evidence = 0.0, size_m = 0.0, f_hz = 0.0;
};

/// How much of a fit's residuals a wave would explain, over the frequencies of range_of(). The evidence is averaged
/// over amplitudes (three decades), frequencies and phases. This is the slowest of all scans, and the same for every
/// effect that is a wave.
Wave find_wave(const ScoreSpace& space);

/// That wave as an effect: the sway of a camera, or the acceleration of a shaking base that moves the glider in this
/// way.
EffectScan scan_waves(const ScoreSpace& space, std::size_t effect, const Wave& wave);

/// A hand that pushes at the start of clips until one moment: a size in each motion that begins with its clip.
///
/// Nine times in ten it is one hand: its pushes are a common size along the motions and, from clip to clip, half as
/// much again (one standard deviation), all along the motions or, one time in ten of these, all against them. Otherwise
/// they have any size and sign. The evidence is averaged over both, over the sizes and over the moment.
EffectScan scan_pushes(const ScoreSpace& space, std::size_t effect);

}  // namespace glidelab::diagnose
