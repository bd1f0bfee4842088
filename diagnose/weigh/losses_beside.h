/// Frames that are missing beside another effect.
///
/// Next to a force or a displacement that the nominal model lacks, losses that no jump shows by itself do not count
/// (missing_frames.h): any curve looks like a row of them. With that effect in the fit they do.
#pragma once

#include <set>

#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// Looks for missing frames along the fits of the likeliest effects, alone or beside the losses that are known; what is
/// found joins the comparison. Nothing is done where no frame is missing for all to see. `nominal` is the nominal fit.
void add_losses_beside(const TrackSet& set, const MotionFit& nominal, const std::set<std::size_t>& without,
                       const Work& work, Comparison& comparison);

}  // namespace glidelab::diagnose
