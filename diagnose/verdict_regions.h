/// Where a gap lies: the regions of each variable in which something unnamed would act, and those in which a named
/// effect shows in the pictures.
#pragma once

#include <vector>

#include "diagnose/diagnosis.h"
#include "diagnose/frame_effects.h"
#include "diagnose/picture_evidence.h"
#include "diagnose/track_set.h"
#include "diagnose/unnamed.h"

namespace glidelab::diagnose {

/// Regions and curves of the families that are worth it, corrected for as many looks.
void add_regions(const TrackSet& set, const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis);

/// Where errors of single frames come together, if that says more than any unnamed function. Whether it does.
bool add_error_runs(const TrackSet& set, const std::vector<FrameEffect>& frames,
                    const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis);

/// Where in the data a named effect shows that only pictures tell.
void add_picture_regions(const PictureEvidence& pictures, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
