/// Where a stated scale holds, if a lens or a turned plane makes the scale differ from place to place.
///
/// The laws of effects.h let the scale hold at x = 0, the edge of the image, whereas a person measures it along the
/// path. With y the fit's position, seen at f(y), the scale of the images is f'(y) times that at x = 0, and lengths are
///
///     true = s (fitted),    s = mean of f' over the path,    sd(s) = standard deviation of f' along the path:
///
/// nobody says which part of the path was measured.
#pragma once

#include "diagnose/model/track_model.h"

namespace glidelab::diagnose {

/// True lengths over those of a fit.
struct ScaleFactor {
  double value = 1.0, sd = 0.0;
};

/// For a scale that was measured along the path from model.x_low_m to model.x_high_m (as seen). 1 ± 0 without an effect
/// that makes the scale differ.
ScaleFactor scale_along_path(const TrackModel& model);

}  // namespace glidelab::diagnose
