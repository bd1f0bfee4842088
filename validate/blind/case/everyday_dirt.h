/// The small imperfections of an experiment as a student records it; none of them is on the list.
///
/// Each is an alteration of forces or of what is seen by an amplitude below its most. Each gets a part of the excess
/// that dirt is to make, between a fourth and four times another's, as far as its most allows; then all grow with one
/// common size until they make that excess together. `s a` is the amplitude at that size, z a deviate of each clip:
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
/// Noise is no gap: what is random from frame to frame (the tracker's noise, a hand that clicks, rounding) is counted
/// in the noise of a position, and has no part of the excess.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

struct EverydayDirt {
  std::string id;
  double amplitude = 0.0;  ///< in `unit`, at size 1 of `effect`
  std::string unit;
  std::vector<std::string> effects;  ///< ids of effects.md that are a fair name for it
  BlindEffect effect;                ///< `largest` where the amplitude is the most
  double part = 1.0;                 ///< size of `effect` at the common size 1

  /// Size of `effect` at a common size.
  double size_at(double common) const { return std::min(common * part, effect.largest); }
};

/// What is random in single positions; noise_sd_m of the design is the sd of all three together.
struct EverydayNoise {
  double white_sd_m = 0.0;
  double clicked_sd_m = 0.0;    ///< of a hand that clicks; 0: positions are not clicked
  double clicked_frames = 0.0;  ///< over which its error is forgotten (1/e)
  double rounded_m = 0.0;       ///< step; 0: not rounded
};

/// `many` of the list, none that `without` names as an effect of the list that would be a fair name for it.
std::vector<EverydayDirt> draw_dirt(std::size_t many, const std::vector<std::string>& without,
                                    const BlindDesign& design, BlindRandom& random);

/// All of them as one effect, by their common size.
BlindEffect all_of_dirt(const std::vector<EverydayDirt>& dirt);

/// One or two kinds (or none) of a total of noise_sd_m.
EverydayNoise draw_noise(double noise_sd_m, bool clicked, bool rounded, BlindRandom& random);

/// The positions with the noise on them.
std::vector<double> with_noise(std::vector<double> x_m, const EverydayNoise& noise, BlindRandom& random);

}  // namespace glidelab::validate
