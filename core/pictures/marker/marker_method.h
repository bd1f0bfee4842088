/// How the object of a path is measured: as a uniform or a shaded disc (marker.h) or, if its hue is known, by its
/// centroid.
#pragma once

#include <optional>

#include "core/pictures/marker/marker.h"
#include "core/pictures/marker/marker_path.h"

namespace glidelab::core {

/// The centroid of a coloured object that is not a disc.
///
/// Pixels that stand out from the background by more than a fifth of the peak and hang together with the brightest one
/// near the guess count in proportion to how far they rise above that floor, so that a pixel that comes or goes at the
/// edge does not matter. Unlike the fit of marker.h it follows the slope of the background.
///
/// sd_px is not estimated (0). Nothing where nothing stands out, or its size is off by more than a factor of 2.
std::optional<MarkerFit> centroid_of_marker(const Signal& signal, const MarkerGuess& guess);

/// Nothing if the object cannot be fitted in this way or its contrast is too low. `undecided` is a uniform disc or, if
/// none fits and a hue is searched for, the centroid.
std::optional<MarkerFit> measure_marker(const Signal& signal, const MarkerGuess& guess, MarkerMethod method,
                                        SignalKind kind);

/// Chooses the path's method by the residuals of its samples (for an object of known hue also by which method is
/// steadier), and measures its sightings so far again with it.
void choose_method(MarkerPath& path, SignalKind kind, const RadiusAt& radius_at);

}  // namespace glidelab::core
