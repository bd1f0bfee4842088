/// Clips that scatter, beside a law that all clips have in common.
///
/// The search for pairs (weigh/hypothesis_pairs.h) leaves out what differs from clip to clip: beside a wrong law it
/// takes up whatever that law leaves, and a remainder that scatters from clip to clip leaves nothing of it to be seen.
/// Of a recording in which a law is missing and friction scatters as well neither name alone is then enough. So the
/// likeliest laws are fitted once more with clips that scatter beside them, by the noise alone, and these pairs are
/// weighed like every other explanation.
#pragma once

#include <optional>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// `law` with clip_scatter as well, by the noise of `set` alone; nothing where these clips cannot show it, or where the
/// fit does not work.
std::optional<MotionFit> with_clip_scatter(const TrackSet& set, const MotionFit& law);

}  // namespace glidelab::diagnose
