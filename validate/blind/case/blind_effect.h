/// One effect of a blind case: what it alters, by a size that can be changed with all else held.
///
/// Each is written here anew, by ratios that a person would think in (a share of the drag, of the friction, of a frame)
/// and as an alteration of forces, frame times or positions; nothing of the diagnosis' models is used. All that is
/// random in an effect is drawn when it is made.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

struct BlindEffect {
  std::string id;
  double largest = 0.0;  ///< size, in a unit of its own; 0 is absence
  /// Alters the film of clip number `clip`.
  std::function<void(double size, std::size_t clip, BlindFilm& film)> put;
  /// The parameters of effects.md at a size; empty for what is outside the library.
  std::function<std::map<std::string, double>(double size)> truth;
  /// How a case of it differs at random from point to point (jitter, outliers): the expected gain in log likelihood at
  /// a size, by the noise of a position and the speed of each frame. Not set for what displaces positions smoothly.
  std::function<double(double size, double noise_sd_m, const std::vector<std::vector<double>>& speed_m_s)> gain;
  std::string variable;  ///< in which it lies: x_m, v_m_s, t_s, clip, mass_kg; for what is outside
};

/// An id, and what draws an effect of it.
using DrawnEffect = std::pair<std::string, std::function<BlindEffect(const BlindDesign&, BlindRandom&)>>;

/// +1 or -1, each as likely.
double either_sign(BlindRandom& random);
/// An angle for each clip, in [0, 2 pi).
std::vector<double> phases(const BlindDesign& design, BlindRandom& random);
/// A frequency of three periods a clip or more, at most 0.35 of the frame rate and 40 Hz.
double wave_hz(const BlindDesign& design, BlindRandom& random);

}  // namespace glidelab::validate
