/// The noise of resting pixels against their brightness, compared with shot noise and a linear sensor:
///
///     variance = dark + gain level      (codes²; level in codes above the black)
///
/// The light's own noise grows as its root, and `gain` is the codes of one electron; `dark` holds read noise and
/// rounding (1/12). Weighted least squares over the levels that were seen, neither below 0. What lies off that line is
/// a tone curve, a codec or a camera's own smoothing.
#pragma once

#include <optional>
#include <vector>

#include "core/result/picture_record.h"

namespace glidelab::diagnose {

struct NoiseLaw {
  double gain_code = 0.0, gain_sd = 0.0;
  double dark_code2 = 0.0;
  double at(double level_code) const { return dark_code2 + gain_code * level_code; }  ///< codes²
};

/// Nothing of fewer than three levels, or of levels that are all one.
std::optional<NoiseLaw> noise_law(const std::vector<core::NoiseAtLevel>& levels);

}  // namespace glidelab::diagnose
