/// Motions on which no diagnosis can speak.
#pragma once

#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/result/results.h"

namespace glidelab::diagnose {

/// InputError, an issue for each clip whose positions cannot be a body's on a straight incline, as the check of a
/// recording finds it (core/check/motion_look.h): an unusable motion gets no verdict.
void require_usable_motions(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups);

}  // namespace glidelab::diagnose
