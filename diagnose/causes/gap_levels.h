/// Whether the nominal model holds within a clip, within a configuration, or across all configurations.
///
/// The nominal model is fitted to all clips together, to the clips of each configuration (one mass on one set-up) by
/// themselves, and to each clip by itself. The gap of a level is sqrt(chi²/(n - p)), with chi² the sum of squared
/// residuals in units of the noise, n the number of positions and p the number of fitted parameters. It is 1 where the
/// model holds at that level.
#pragma once

#include <optional>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// `nominal` is the nominal fit to all of `set`, by the noise alone; `jobs` fits run at a time.
GapLevels levels_of(const TrackSet& set, const MotionFit& nominal, int jobs);

}  // namespace glidelab::diagnose
