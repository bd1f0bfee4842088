/// What a blind case has besides the nominal law: the effects that a diagnosis may name, and those that nobody listed.
///
/// Each is written here anew, by ratios that a person would think in (a share of the drag, of the friction, of a frame)
/// and as an alteration of forces, frame times or positions; nothing of the diagnosis' models is used. All that is
/// random in an effect is drawn when it is made, so that its size can be changed with the rest held.
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

/// Ids of effects.md that tracks can show.
const std::vector<std::string>& library_effects();
/// Ids of what is not in it and may never be added to it.
const std::vector<std::string>& outside_effects();

/// One of either list; std::out_of_range for another id.
BlindEffect draw_effect(const std::string& id, const BlindDesign& design, BlindRandom& random);

}  // namespace glidelab::validate
