/// Effects of effects.md that lie in the camera, its clock and the noise of positions, not in the forces; and what the
/// effects of either kind draw alike.
#pragma once

#include <vector>

#include "validate/blind/case/blind_effects.h"

namespace glidelab::validate {

const std::vector<DrawnEffect>& seen_library();

/// +1 or -1, each as likely.
double either_sign(BlindRandom& random);
/// An angle for each clip, in [0, 2 pi).
std::vector<double> phases(const BlindDesign& design, BlindRandom& random);
/// A frequency of three periods a clip or more, at most 0.35 of the frame rate and 40 Hz.
double wave_hz(const BlindDesign& design, BlindRandom& random);

}  // namespace glidelab::validate
