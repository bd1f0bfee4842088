/// Whether the law holds within a clip, within a configuration, or across all of them.
///
/// The nominal model is fitted to all clips, to those of each configuration (mass and set-up) by themselves, and to
/// each clip by itself. The gap of a level is the root of the sum of squared residuals over the noise, divided by the
/// number of positions less the number of fitted parameters. It is 1 where the law holds at that level.
#pragma once

#include <optional>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// `nominal` is the fit to all of `set`, by the noise alone.
GapLevels levels_of(const TrackSet& set, const MotionFit& nominal, int jobs);

}  // namespace glidelab::diagnose
