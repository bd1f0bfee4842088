/// The verdict, the causes in order, what remains, and K/m, mu and alpha with the causes in the model.
///
/// If the likeliest explanation by the noise alone leaves a gap, or if something without a name is likely, explanations
/// are weighed beside a remainder (causes/cause_weighing.h). The verdict then follows the share of the gap that the
/// named causes take: it is `effect` if they take half or more. Without a gap, a name must do more than small
/// imperfections would.
#pragma once

#include <cstddef>
#include <vector>

#include "base/long_work.h"
#include "diagnose/pictures/image_evidence.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {

/// `first` is the comparison by the noise alone, without the effects in `left_out`.
Diagnosis with_causes(const TrackSet& set, Comparison first, ImageEvidence images,
                      const std::vector<std::size_t>& left_out, int jobs, const base::Progress& progress);

}  // namespace glidelab::diagnose
