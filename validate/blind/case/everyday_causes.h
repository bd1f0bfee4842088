/// Main causes of everyday experiments: those of the clean blind cases that affect a track, and those typical of an
/// apparatus.
///
/// The laws of effects.md that the clean cases lack, implemented independently, with s the size and z a deviate drawn
/// for the case (of sd 1):
///
///     direction_dependent_drag   K (1 + s sign(v))
///     place_friction             mu (1 + s z(x)), z a sum of waves with mean 0 over the positions of the design
///     friction_drift             mu (1 ± s c), c the clip's number from 0
///     configuration_friction     mu (1 + s z_j), j the configuration (mass and group), z of mean 0 over them
///     configuration_drag         K (1 + s z_j)
///     clip_scatter               mu (1 + s z_c), K (1 + r s y_c), each clip its own deviates
///     end_stop                   -k (x - x_b) beyond x_b, at one of the two ends
#pragma once

#include <string>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

/// Ids of effects.md that affect a track, without those of the noise and of the times of single frames.
const std::vector<std::string>& everyday_effects();
/// Ids of effects outside the list. Position-dependent friction and drag by clip or configuration are not among them:
/// the list has these.
const std::vector<std::string>& everyday_outside();

/// Draws an effect of either list; std::out_of_range for another id.
BlindEffect draw_everyday_effect(const std::string& id, const BlindDesign& design, BlindRandom& random);

/// A clip's configuration: the same number for clips of one mass and one group.
std::size_t configuration_of(const BlindDesign& design, const BlindClip& clip);

/// Other ids that give the same law on a design for any parameters: naming one of them is equally right. `down` says
/// whether an end_stop is at the downhill end, where a tether is equivalent.
std::vector<std::string> equals_of(const std::string& id, const BlindDesign& design, bool down);

/// Smooth random function of x: four waves of lengths between `shortest` and `longest`, of rms 1 over all x.
std::function<double(double)> random_waves(double shortest_m, double longest_m, BlindRandom& random);

}  // namespace glidelab::validate
