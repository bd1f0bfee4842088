/// How the object of a path is measured: as a uniform or a shaded disc (marker_fit.h) or, if it may have any shape
/// (may_have_any_shape() in marker_search.h), by its centroid.
#pragma once

#include <optional>

#include "core/pictures/marker/marker_fit.h"
#include "core/pictures/marker/marker_path.h"

namespace glidelab::core {

/// The centroid of an object that need not be a disc.
///
/// Pixels count if they stand out from the background by more than a fifth of the peak and are connected with the
/// brightest one near the guess. Each counts in proportion to its height above that floor, so that a pixel that comes
/// or goes at the edge does not matter. Unlike the fit of marker_fit.h, a centroid follows the slope of the background.
///
/// sd_px is not estimated (0). Empty if nothing stands out, if these pixels come within 2 px of the image's edge, which
/// may cut off others, or if its radius is off by more than a factor of 2.
std::optional<MarkerFit> centroid_of_marker(const Signal& signal, const MarkerGuess& guess);

/// The object by one method. Empty if it cannot be measured in this way, or if its contrast is too low. `undecided` is
/// a uniform disc or, if none fits and the object may have any shape, the centroid.
std::optional<MarkerFit> measure_marker(const Signal& signal, const MarkerGuess& guess, MarkerMethod method,
                                        SignalKind kind);

/// A measurement, and what it started from.
struct MeasuredMarker {
  MarkerGuess guess;
  MarkerFit fit;
};

/// The object near `guess`, whose centre is only known to about a third of the radius (a blob): from there or, if that
/// fails, from the centroid of what stands out there. A fit settles only from within some three pixels of the centre,
/// and light from one side, or something bright nearby, draws a blob farther away.
std::optional<MeasuredMarker> measure_near(const Signal& signal, const MarkerGuess& guess, MarkerMethod method,
                                           SignalKind kind);

/// A disc of about the stated size that is lit from one side, where no uniform disc fits: the blob is that of its lit
/// part, so that fits start on all sides of its centroid. Empty for one too small to tell shading from a shift.
std::optional<MeasuredMarker> measure_lit(const Signal& signal, const MarkerGuess& guess, SignalKind kind);

/// Chooses the method of a path by the residuals of its samples and, for an object that may have any shape, by which
/// method is steadier. Replaces the sightings so far by those of that method.
void choose_method(MarkerPath& path, SignalKind kind, const RadiusAt& radius_at);

}  // namespace glidelab::core
