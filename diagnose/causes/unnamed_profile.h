/// The evidence of a function without a name beside a fit and its remainder.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/causes/explanation_profile.h"
#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

/// Log evidence of a fit with the likeliest function without a name beside it: one that all clips share, or one with a
/// size for each clip. Empty if there is none.
std::optional<double> unnamed_profile(const TrackSet& set, const TrackSet& with, const Profile& nominal,
                                      const MotionFit& noise_alone, const std::vector<UnnamedFamily>& families,
                                      const RemainderSizes& start);

}  // namespace glidelab::diagnose
