/// What a filmed blind case has besides what its folder says: effects of effects.md made in the scenario, in what
/// experiment.toml says of it, or in the images; and some that are not on the list.
///
/// Strength of what displaces positions is the log likelihood of blind_strength.h, the noise being the bound that the
/// camera's noise sets. What moves no position has that of blind_picture_effects.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validate/blind/case/blind_case.h"
#include "validate/blind/case/blind_scene.h"

namespace glidelab::validate {

/// Ids of effects.md that a filmed case may have, and of what is in no list.
const std::vector<std::string>& filmed_effects();
const std::vector<std::string>& filmed_outside_effects();

/// Whether it is made in images that are filed anew, which a file with loss would show twice.
bool needs_lossless(const std::string& id);

/// Puts the effect into the scene with about the wanted gain; nothing where that scene cannot show it.
/// std::out_of_range for an id of neither list.
std::optional<BlindCause> put_filmed_effect(const std::string& id, double wanted, BlindScene& scene,
                                            BlindRandom& random);

}  // namespace glidelab::validate
