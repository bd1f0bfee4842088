/// Causes that are tried in addition to those of an explanation.
///
/// The search for pairs (weigh/hypothesis_pairs.h) leaves out effects that differ from clip to clip. Beside a wrong law
/// they absorb whatever that law leaves, and a remainder that scatters from clip to clip hides them. If a law is
/// missing and friction scatters as well, neither name alone is then enough. The likeliest laws are therefore fitted
/// once more together with clips that scatter, by the noise alone, and these pairs are weighed like every other
/// explanation.
///
/// It also ends with two causes. But nearly every recording begins in a hand, and what the hand does in the first tenth
/// of a second is so far above the noise that one of the two is then the hand. The likeliest explanations are therefore
/// fitted once more together with a hand. A scale or a clock that is off is tried in the same way if the inclinations
/// that are stated contradict the motion: what makes the gap does not tell of it.
#pragma once

#include <optional>
#include <set>
#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// The fit of `law` together with clip_scatter, by the noise of `set` alone. Empty if these clips cannot show it, or if
/// the fit fails.
std::optional<MotionFit> with_clip_scatter(const TrackSet& set, const MotionFit& law);

/// The fit of `law` together with one more effect, by the noise of `set` alone. Empty if the effect does not show
/// beside the law and its remainder, whose sizes are `sizes`, or if the fit fails.
std::optional<MotionFit> with_further(const TrackSet& set, const MotionFit& law, std::size_t effect,
                                      const RemainderSizes& sizes);

/// The laws that show best beside clips that scatter, whose fit is `scatter` and whose remainder is `sizes`, each
/// fitted together with them by the noise alone. A law that takes less than the scatter does hardly shows by itself, so
/// the likeliest laws by themselves may be others. `without` are indices of effects that are left out.
std::vector<MotionFit> laws_beside_scatter(const TrackSet& set, const MotionFit& scatter, const RemainderSizes& sizes,
                                           const std::set<std::size_t>& without);

/// Missing frames without any effect: of those that were found with these fits, the ones with which the motion is
/// followed best by the noise alone. Empty if none has any, or if no fit succeeds.
std::optional<MotionFit> lost_frames_alone(const TrackSet& set, const std::vector<MotionFit>& fits, int jobs);

}  // namespace glidelab::diagnose
