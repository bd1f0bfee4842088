/// Effects of effects.md that lie in the camera, its clock and the noise of positions, not in the forces.
#pragma once

#include <vector>

#include "validate/blind/case/blind_effect.h"

namespace glidelab::validate {

const std::vector<DrawnEffect>& seen_library();

}  // namespace glidelab::validate
