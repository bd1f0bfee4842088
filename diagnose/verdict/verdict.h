/// From a comparison of hypotheses to a diagnosis: the verdict, its effects, where the gap lies, and how large it is.
#pragma once

#include <vector>

#include "diagnose/pictures/image_evidence.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// For a comparison that counts a remainder as noise: the same motions with the noise alone, in which the gap is
/// measured.
struct NoiseAlone {
  const TrackSet& set;
  const MotionFit& nominal;
  const MotionFit& best;      ///< with the causes that the verdict names
  const TrackSet& sized_set;  ///< with the remainder beside these causes as noise,
  const MotionFit& sized;     ///< and the fit to it: the sizes that the verdict gives
};

/// Effects that could replace one effect of an explanation: with as much evidence, and with as little left of the gap.
/// Not one that acts together with it in most of the probability of either: then neither stands for the other.
std::vector<std::size_t> not_told_apart(const Comparison& comparison, const Hypothesis& best, std::size_t effect,
                                        bool filmed);

Diagnosis verdict_of(const TrackSet& set, const Comparison& comparison, ImageEvidence images = {},
                     const NoiseAlone* noise_alone = nullptr);

/// Lowers every probability to `most` at most, where one is higher. The rest goes to the unknown, and of an unknown
/// that is too likely itself to all else; so the sum stays 1.
void cap_probabilities(double most, Diagnosis& diagnosis);

/// Explanations that name something, by falling probability; those with next to none by falling evidence.
std::vector<RankedExplanation> ranking_of(const TrackSet& set, const Comparison& comparison,
                                          const NoiseAlone* noise_alone);

}  // namespace glidelab::diagnose
