/// Motions that no diagnosis can judge.
#pragma once

#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/result/results.h"

namespace glidelab::diagnose {

/// InputError, with an issue for each clip whose positions cannot be those of a body on a straight incline, as the
/// check of a recording finds (core/check/motion_look.h): an unusable motion gets no verdict.
void require_usable_motions(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups);

}  // namespace glidelab::diagnose
