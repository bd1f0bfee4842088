/// The verdict, the causes in order, what remains, and what K/m, mu and alpha are with the causes in the model.
///
/// Where the likeliest explanation by the noise alone leaves a gap, or something without a name is likely, explanations
/// are weighed beside a remainder (causes/cause_weighing.h), and the verdict goes by the share of the gap that the
/// named causes take: `effect` where they take half of it. Without a gap a name must do more than small imperfections
/// would.
#pragma once

#include <cstddef>
#include <vector>

#include "base/long_work.h"
#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {

/// `first` is the comparison by the noise alone, without the effects in `left_out`.
Diagnosis with_causes(const TrackSet& set, Comparison first, PictureEvidence pictures,
                      const std::vector<std::size_t>& left_out, int jobs, const base::Progress& progress);

}  // namespace glidelab::diagnose
