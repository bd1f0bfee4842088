/// What a blind case contains besides the nominal law: the effects that a diagnosis may name, and some that are not on
/// its list.
#pragma once

#include <string>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

/// Effects of effects.md that lie in the camera, its clock or the noise of positions, not in the forces.
const std::vector<DrawnEffect>& seen_library();

/// Ids of effects.md that tracks can show.
const std::vector<std::string>& library_effects();
/// Ids of effects that are not in it and must never be added to it.
const std::vector<std::string>& outside_effects();

/// One of either list; std::out_of_range for another id.
BlindEffect draw_effect(const std::string& id, const BlindDesign& design, BlindRandom& random);

}  // namespace glidelab::validate
