/// Clips that scatter, in addition to a law that all clips have in common.
///
/// The search for pairs (weigh/hypothesis_pairs.h) leaves out effects that differ from clip to clip. Beside a wrong law
/// they absorb whatever that law leaves, and a remainder that scatters from clip to clip hides them. If a law is
/// missing and friction scatters as well, neither name alone is then enough. The likeliest laws are therefore fitted
/// once more together with clips that scatter, by the noise alone, and these pairs are weighed like every other
/// explanation.
#pragma once

#include <optional>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// The fit of `law` together with clip_scatter, by the noise of `set` alone. Empty if these clips cannot show it, or if
/// the fit fails.
std::optional<MotionFit> with_clip_scatter(const TrackSet& set, const MotionFit& law);

}  // namespace glidelab::diagnose
