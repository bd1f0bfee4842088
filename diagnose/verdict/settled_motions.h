/// The motions of an analysis as every fit of a diagnosis uses them, and the noise of their positions.
///
/// The noise comes from neighbouring positions alone. If the analysis took part of the motion for a hand or a stop, the
/// whole motion is tried first, since a lasting push or a cable that tightens looks like that. If a fit leaves too much
/// of it, the disputed part is left out, and a note says so.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/pictures/image_evidence.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// The motions including what the analysis took for a hand or a stop. Driven motions are cut into pieces, and notes say
/// what a reader should know of the data. `setups` are the clips of all folders in the order of the results. InputError
/// if there is too little motion for a fit (fewer positions in all than the model's parameters and six more), or none
/// that could be that of a glider (tracks/usable_motions.h).
TrackSet whole_motions(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups);

/// The same without the `disputed` frames that the analysis took for a hand or a stop. Empty if too little is left.
std::optional<TrackSet> motions_without_hand(const core::AnalysisResults& results,
                                             const std::vector<core::ClipSetup>& setups, std::size_t disputed);

/// Whether a fit to `set` explains the frames that `trimmed` lacks, which look like a hand or a stop. Laws that act
/// throughout do if they leave at most a tenth of the nominal model's chi² there. An end stop, a cable or lost
/// frames do if held-out positions lie about as far off as without these frames. What is left is then something else,
/// which acts throughout.
bool explains_disputed(const TrackSet& set, const MotionFit& nominal, const MotionFit& fit, const TrackSet& trimmed);

/// Finds the noise of every position from single frames and from what the images show of a codec, and sets outliers
/// aside. Missing frames are corrected first: a jump is neither noise nor an outlier. Also takes the speed at which the
/// images show the camera to drift (TrackSet::camera_drift_m_s).
void settle_noise(const ImageEvidence& images, TrackSet& set);

/// Whether the nominal model, whose fit is `nominal`, would follow the motions far better with the recorded forces
/// reversed: with a quarter of its chi² or less, where that is a misfit.
std::optional<ForceReversed> reversed_force(const TrackSet& set, const MotionFit& nominal);

/// What the nominal model lacks of a strong effect (a bounce, the drag of a fall) is in part taken for noise of filmed
/// positions. If an explanation leaves less than half of that noise's variance, finds the noise anew from what it
/// leaves. Whether it did.
bool settle_noise_again(const MotionFit& explanation, TrackSet& set);

}  // namespace glidelab::diagnose
