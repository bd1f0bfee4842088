/// How a path's thing is measured: as a uniform or a shaded disc (marker.h), or, known by its hue, by its centroid.
#pragma once

#include <optional>

#include "core/pictures/marker/marker_path.h"

namespace glidelab::core {

/// Nothing where the thing cannot be fitted so, or stands out too little. `undecided` is a uniform disc or, where none
/// fits and a hue is looked for, the centroid.
std::optional<MarkerFit> measure_marker(const Signal& signal, const MarkerGuess& guess, MarkerMethod method,
                                        SignalKind kind);

/// Chooses the path's method by what its samples leave of residuals (for a thing known by its hue also by which is
/// steadier), and measures its sightings so far again in that way.
void choose_method(MarkerPath& path, SignalKind kind, const RadiusAt& radius_at);

}  // namespace glidelab::core
