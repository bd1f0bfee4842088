/// A pixel's noise against its brightness: for a sensor without a tone curve the variance grows in proportion to the
/// level (the light's own noise) from that of the darkest.
///
/// Pixels are put into groups of equal ranges of level. A pixel's variance is half the mean square of its changes from
/// one frame to the next. How well a group's is known allows for what pixels blurred by 1 px have in common with their
/// neighbours (squares correlate by exp(-d²/2) at d px: 2 pi count as one) and successive changes (1/4 each: 1.5), and
/// for 2 % that fitting a patch's light and place takes up.
#pragma once

#include <vector>

#include "core/result/picture_record.h"

namespace glidelab::core {

/// Of one pixel.
struct PixelChange {
  double level_code = 0.0;
  double squares = 0.0;  ///< sum of its changes' squares
  double changes = 0.0;  ///< how many
};
using PixelChanges = std::vector<PixelChange>;

/// Of the (blurred) pixels; a group whose relative standard deviation exceeds a tenth is left out.
std::vector<NoiseAtLevel> noise_by_level(const PixelChanges& pixels);

}  // namespace glidelab::core
