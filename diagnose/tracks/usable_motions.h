/// Motions that no diagnosis can judge, and those whose units have to be checked first.
#pragma once

#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/result/results.h"
#include "diagnose/result/note.h"

namespace glidelab::diagnose {

/// What the check of a recording finds in the motions (core/check/motion_look.h). InputError, with an issue for each
/// clip whose positions cannot be those of a body on a straight incline, or whose film is interlaced, for each that
/// moves opposite to its stated launch where most do, and for each configuration whose x seems to rise uphill
/// (core/result/uphill.h): an unusable motion gets no verdict. Otherwise the clips that make a unit of lengths or
/// times, or a scale, doubtful, and the first of each configuration that falls far too slowly (core::slow_fall()).
std::vector<DoubtfulUnit> doubtful_units(const core::AnalysisResults& results,
                                         const std::vector<core::ClipSetup>& setups);

}  // namespace glidelab::diagnose
