/// The small imperfections of an experiment recorded by a student; none of them is on the list.
///
/// Each alters forces or seen positions with an amplitude below its maximum. Each gets a part of the total excess of
/// all of them, between a quarter of and four times another's, as far as its maximum allows; then all grow with one
/// common size until together they make that excess. `s a` is the amplitude at that size, z a deviate of each clip:
///
///     scattered_friction   mu (1 + s a z)                         a up to 15 %
///     wavy_track           slope + s a waves(x), 0.15 to 1.2 m    a up to 4 mrad
///     lagging_tracker      follows x by a first-order lag of s a (1 + 0.4 z)    a up to two frames
///     draught              s a (two slow waves of t, of each clip)   a up to 15 mN
///     wrong_mass           one configuration is heavier or lighter by s a       a up to 3 %
///     unfree_start         a hand pushes or brakes in the first 20 to 80 ms, s a z   a up to 3 m/s²
///     bad_clip             one clip is kicked (s a for 30 to 80 ms, a up to 4 m/s²), or its friction is 1 + s a times,
///                          a up to 1.5
///
/// Noise does not contribute to the gap: anything random from frame to frame (the tracker's noise, manual clicks,
/// rounding) counts as noise of a position and has no part in the excess.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

struct EverydayImperfection {
  std::string id;
  double amplitude = 0.0;  ///< in `unit`, at size 1 of `effect`
  std::string unit;
  std::vector<std::string> effects;  ///< ids of effects.md that are acceptable names for it
  BlindEffect effect;                ///< `largest` at the maximum amplitude
  double part = 1.0;                 ///< size of `effect` at the common size 1

  /// Size of `effect` at a common size.
  double size_at(double common) const { return std::min(common * part, effect.largest); }
};

/// Random errors of single positions; noise_sd_m of the design is the sd of all three together.
struct EverydayNoise {
  double white_sd_m = 0.0;
  double clicked_sd_m = 0.0;    ///< of manual clicks; 0: positions are not clicked
  double clicked_frames = 0.0;  ///< correlation length of its error (1/e)
  double rounded_m = 0.0;       ///< step; 0: not rounded
};

/// Draws `many` from the list, excluding any for which an effect in `without` would be an acceptable name.
std::vector<EverydayImperfection> draw_imperfections(std::size_t many, const std::vector<std::string>& without,
                                                     const BlindDesign& design, BlindRandom& random);

/// All of them as one effect, with their common size.
BlindEffect all_of_imperfections(const std::vector<EverydayImperfection>& imperfections);

/// Noise of one or two kinds (or none), with a total of noise_sd_m.
EverydayNoise draw_noise(double noise_sd_m, bool clicked, bool rounded, BlindRandom& random);

/// The positions with added noise.
std::vector<double> with_noise(std::vector<double> x_m, const EverydayNoise& noise, BlindRandom& random);

}  // namespace glidelab::validate
