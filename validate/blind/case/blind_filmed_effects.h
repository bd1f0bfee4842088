/// What a filmed blind case contains besides what its folder says: effects of effects.md made in the scenario, in the
/// statements of experiment.toml, or in the images, and some that are not on the list.
///
/// The strength of effects that displace positions is the log likelihood of blind_strength.h, with the noise given by
/// the bound for the camera's noise. The strength of effects in the images alone, which move no position, is
///
///     gain = z²/2,   z = size / what an image may show with nothing wrong,
///
/// where the denominator is: for exposure_blur, a smear of 0.4 of that of the stated exposure, or 0.2 px; for
/// rolling_shutter, a shear of 0.02 px over the marker's height at its fastest; for light_flicker, 0.2 % of the light
/// (1 % in a lossy file); for light_gradient, 10 % per metre; for compression, z is the codec's quantiser over three
/// times the noise of a pixel, in codes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validate/blind/case/blind_case.h"
#include "validate/blind/case/blind_scene.h"

namespace glidelab::validate {

/// The effects of effects.md that are in the images alone. Each function puts one into the scene with about the wanted
/// gain (down to 0.64 of it where the camera cannot do more), and returns an empty value if that scene cannot show it.
std::optional<BlindCause> long_exposure(double wanted, BlindScene& scene, BlindRandom& random);
std::optional<BlindCause> hidden_rolling(double wanted, BlindScene& scene, BlindRandom& random);
std::optional<BlindCause> flicker(double wanted, BlindScene& scene, BlindRandom& random);
std::optional<BlindCause> gradient(double wanted, BlindScene& scene, BlindRandom& random);

/// Compressed with loss, then rewritten without loss: nothing states it.
std::optional<BlindCause> hidden_codec(double wanted, BlindScene& scene, BlindRandom& random);

/// Ids of effects.md that a filmed case may have, and ids of effects on no list.
const std::vector<std::string>& filmed_effects();
const std::vector<std::string>& filmed_outside_effects();

/// Whether it is made in rewritten images, in which a lossy codec would act twice.
bool needs_lossless(const std::string& id);

/// Puts an effect of either list into the scene with about the wanted gain; empty if the scene cannot show it.
/// std::out_of_range for an id of neither list.
std::optional<BlindCause> put_filmed_effect(const std::string& id, double wanted, BlindScene& scene,
                                            BlindRandom& random);

}  // namespace glidelab::validate
