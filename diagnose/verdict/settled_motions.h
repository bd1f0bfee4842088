/// The motions of an analysis as every fit of a diagnosis uses them, and the noise of their positions.
///
/// The noise comes from neighbouring positions alone. Where the analysis took part of the motion for a hand or a stop,
/// all of it is tried first (a push that lasts, a cable that tightens look like that); where a fit leaves too much of
/// it, the part in dispute is left out, and a note says so.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// With what the analysis took for a hand or a stop; driven motions are cut into pieces, and notes say what a reader
/// should know of the data. `setups` are all folders' clips in the results' order. InputError where there is too little
/// motion for a fit (25 positions in all), or none that could be one of a glider (tracks/usable_motions.h).
TrackSet whole_motions(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups);

/// The same without the `disputed` frames that the analysis took for a hand or a stop; nothing where too little is left
/// then.
std::optional<TrackSet> motions_without_hand(const core::AnalysisResults& results,
                                             const std::vector<core::ClipSetup>& setups, std::size_t disputed);

/// Finds the noise of every position, from what single frames and a codec's images show of it, and sets aside what is
/// not noise. Missing frames are corrected first: a jump is neither noise nor an outlier.
void settle_noise(const PictureEvidence& pictures, TrackSet& set);

/// Whether a fit leaves so much that the motion counts as not explained: chi² above 1.5 per point.
bool is_misfit(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
