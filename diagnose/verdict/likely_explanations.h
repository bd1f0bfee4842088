/// The explanations that are likely enough to count, beside the one that is reported: they widen what is recovered, and
/// studies record their motions again.
#pragma once

#include <vector>

#include "diagnose/causes/cause_weighing.h"
#include "diagnose/recovered/recovered.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

inline constexpr double kLikely = 0.02;  ///< probability from which an explanation counts

/// A fit that stopped at its limit on steps, and where further steps lead.
struct MovedOn {
  MotionFit fit;
  bool at_minimum = true;  ///< or so near that as many steps again lower chi² by less than a tenth
};

/// Goes on from a fit in up to three further descents, unless it is at its minimum. An effect whose sizes the data
/// hardly determine leads along a valley in which chi² hardly falls: what it does to K, mu and the inclination is known
/// long before the end of it.
MovedOn moved_on(const TrackSet& set, const MotionFit& fit, bool at_minimum);

/// Adds the explanations other than the reported one, and to that one its probability. The nominal model stands for the
/// unknown.
void add_others(const WeighedCauses& weighed, const std::vector<Hypothesis>& all, double unknown,
                const std::vector<std::size_t>& reported, Explanations& explanations);

/// The same by the noise alone, if nothing was weighed with a remainder.
void add_others(const Comparison& by_noise, const std::vector<Hypothesis>& all, Explanations& explanations);

/// The motions of each explanation as a scenario. Every scenario has the reported effects of the camera.
std::vector<LikelyTwin> likely_twins(const TrackSet& set, const Explanations& explanations,
                                     const std::vector<DiagnosedEffect>& reported);

}  // namespace glidelab::diagnose
