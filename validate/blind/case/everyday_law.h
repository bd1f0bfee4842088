/// What is true of each configuration of an everyday experiment when its causes are part of the law.
///
/// K, mu and alpha are the parameters of effects.md beside the cause's own: K of each configuration under
/// configuration_drag and at the middle of the data under damping_gradient, mu of each under configuration_friction,
/// alpha at the middle under track_bow. The terminal velocity is the lowest v > 0 at which drive, drag and friction
/// balance with the causes that are laws of speed or configuration.
#pragma once

#include <vector>

#include "validate/blind/case/blind_strength.h"
#include "validate/blind/case/everyday_case.h"

namespace glidelab::validate {

/// Of every configuration that has a clip, in the order of the clips. `x_m`: positions of each clip.
std::vector<EverydayConfiguration> everyday_configurations(const BlindDesign& design,
                                                           const std::vector<BlindPut>& causes,
                                                           const std::vector<std::vector<double>>& x_m);

}  // namespace glidelab::validate
