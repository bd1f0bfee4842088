/// The fit of all motions with user-named causes in the model, in place of those that a diagnosis finds.
///
/// Tracks, noise, effects, fit and remainder are those of a diagnosis (diagnose.h, recovered/recovered.h). If a
/// diagnosis names these causes and is certain of them, its `recovered` has the same numbers. No explanation is
/// weighed. Up to three causes are added in every order, more in the given order and its reverse, and the best fit is
/// kept.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/result/given_causes.h"

namespace glidelab::diagnose {

/// Ids of the effects that a fit of the motion can contain: those that change the motion, or what is seen of it, as a
/// whole.
std::vector<std::string> causes_of_motion();

/// InputError for an id that is not among causes_of_motion(), and for one that is given twice. `option` is the option
/// that named them.
void check_given_causes(const std::vector<std::string>& ids, const std::string& option);

/// `setups` are the clips of all folders in the order of the results, `cameras` what is stated of each clip's camera.
/// Frames that the analysis found to be lost count as lost here too.
///
/// InputError as from check_given_causes(), for clips with too little free motion, and for a cause that these
/// recordings cannot show at any size, alone or beside the others; it then lists the effects that they can show.
GivenCauses fit_given_causes(core::AnalysisResults results, const std::vector<core::ClipSetup>& setups,
                             const std::vector<std::optional<core::CameraSettings>>& cameras,
                             const std::vector<std::string>& ids, const std::string& option,
                             const base::Progress& progress = base::no_progress);

}  // namespace glidelab::diagnose
