/// Effects of effects.md that a filmed blind case has in its images alone: they move no position.
///
/// Strength is
///
///     gain = z²/2,   z = size / what a image may show where nothing is wrong,
///
/// for exposure_blur a smear of 0.4 of the stated exposure's or 0.2 px, for rolling_shutter a shear of 0.02 px over the
/// marker's height at its fastest, for light_flicker 0.2 % of the light (1 % in a lossy file), for light_gradient 10 %
/// a metre, for compression the codec's quantiser against three times the noise of a pixel, in codes.
///
/// Each puts the effect into the scene with about the wanted gain (down to 0.64 of it where the camera cannot do more),
/// and nothing where that scene cannot show it.
#pragma once

#include <optional>

#include "validate/blind/case/blind_case.h"
#include "validate/blind/case/blind_scene.h"

namespace glidelab::validate {

std::optional<BlindCause> long_exposure(double wanted, BlindScene& scene, BlindRandom& random);
std::optional<BlindCause> hidden_rolling(double wanted, BlindScene& scene, BlindRandom& random);
std::optional<BlindCause> flicker(double wanted, BlindScene& scene, BlindRandom& random);
std::optional<BlindCause> gradient(double wanted, BlindScene& scene, BlindRandom& random);

/// Compressed with loss, then filed without: nothing says so.
std::optional<BlindCause> hidden_codec(double wanted, BlindScene& scene, BlindRandom& random);

}  // namespace glidelab::validate
