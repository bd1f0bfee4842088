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

/// Regions and curves of the families that are worth it, corrected for as many looks. `nominal` is the fit of the usual
/// model, for what it lacks.
void add_regions(const TrackSet& set, const MotionFit& nominal, const std::vector<UnnamedFamily>& families,
                 Diagnosis& diagnosis);

/// The force that the usual model lacks where it lacks most, as the accelerations show it: m r'' + K r' of what the fit
/// leaves of the positions, their noise included; of all motions the most.
double most_lacking_n(const TrackSet& set, const MotionFit& nominal);

/// Where errors of single frames come together, if that says more than any unnamed function. Whether it does.
bool add_error_runs(const TrackSet& set, const std::vector<FrameEffect>& frames,
                    const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis);

/// Where in the data a named effect shows that only pictures tell.
void add_picture_regions(const PictureEvidence& pictures, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
