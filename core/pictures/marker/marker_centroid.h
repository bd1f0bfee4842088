/// The centroid of a coloured object that is not a disc.
///
/// Pixels that stand out from the background by more than a fifth of the peak and hang together with the brightest one
/// near the guess count in proportion to how far they rise above that floor, so that a pixel that comes or goes at the
/// edge does not matter. Unlike the fit of marker.h it follows the slope of the background.
#pragma once

#include <optional>

#include "core/pictures/marker/marker.h"

namespace glidelab::core {

/// sd_px is not estimated (0). Nothing where nothing stands out, or its size is off by more than a factor of 2.
std::optional<MarkerFit> centroid_of_marker(const Signal& signal, const MarkerGuess& guess);

}  // namespace glidelab::core
