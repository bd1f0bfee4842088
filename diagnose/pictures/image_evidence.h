/// What the images of filmed clips say about effects, apart from the positions found in them.
///
/// Each finding weighs one effect's presence against its absence: a measured size with its standard deviation against
/// what is stated (or against nothing), averaged over the sizes that the effect may have. Standard deviations come from
/// the scatter of the measurements themselves, with what neighbouring frames have in common; a floor allows for errors
/// of the marker's model and of the lens (each derived where it is used).
#pragma once

#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/pictures/image_search.h"

namespace glidelab::diagnose {

/// The filmed clips of an analysis that kept its images; empty if there are none. `cameras`: one for each clip.
std::vector<FilmedClip> filmed_clips(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                                     const std::vector<std::optional<core::CameraSettings>>& cameras);

ImageEvidence image_evidence(std::vector<FilmedClip> clips);

}  // namespace glidelab::diagnose
