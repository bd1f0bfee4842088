/// The fit of all motions with user-named causes in the model, in place of those that a diagnosis finds.
///
/// Tracks, noise, effects, fit and remainder are those of a diagnosis (diagnose.h, causes/recovered.h): where a
/// diagnosis names these causes and is sure of them, its `recovered` has the same numbers. No explanation is weighed.
/// With several causes every order of adding them is tried, and the best fit is kept.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/result/given_causes.h"

namespace glidelab::diagnose {

/// Ids of effects that a fit of the motion can hold: those that change it, or what is seen of it, as a whole.
std::vector<std::string> causes_of_motion();

/// InputError for an id that is not among causes_of_motion(), and for one that stands twice; `option` is where they
/// were named.
void check_given_causes(const std::vector<std::string>& ids, const std::string& option);

/// `setups` are all folders' clips in the results' order, `cameras` what is stated of each clip's camera. Frames that
/// the analysis found to be lost count as lost here too.
///
/// InputError as from check_given_causes(); for clips that hold too little free motion; and for a cause that these
/// recordings cannot show at any size, or not beside the others: it lists those that they can show.
GivenCauses fit_given_causes(core::AnalysisResults results, const std::vector<core::ClipSetup>& setups,
                             const std::vector<std::optional<core::CameraSettings>>& cameras,
                             const std::vector<std::string>& ids, const std::string& option,
                             const base::Progress& progress = base::no_progress);

}  // namespace glidelab::diagnose
