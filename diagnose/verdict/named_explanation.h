/// Which explanation of a comparison a verdict may name.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/causes/cause_sequence.h"
#include "diagnose/causes/remainder.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// Whether an explanation claims nothing but what the images themselves show, and at most the scatter of single
/// positions: nothing that would explain a gap.
bool shows_in_images_alone(const Hypothesis& explanation);

/// Whether the likeliest effect of an explanation, together with those that the data cannot tell from it, is likelier
/// than not. A name that is less likely is no answer. `part_of`: the explanation of which `best` is a part, where
/// others may take the place of an effect that do not without the rest of it.
bool is_likelier_than_not(const TrackSet& set, const Comparison& comparison, const Hypothesis& best,
                          const Hypothesis* part_of = nullptr);

/// The fitted explanation by those causes of `best` that are likelier than not, or by the likeliest of them: the rest
/// of the median probability model (best_named()). A cause counts together with those that no track can tell from it
/// and, if it has a third itself, with those that these data cannot tell from it beside the others; except where `best`
/// has two that are alike: each is then as likely as its own name. What remains is called by the clearly likeliest of
/// the names that these data cannot tell apart. Null if these are all causes of `best`, or if no fit has them alone.
const Hypothesis* likely_part(const TrackSet& set, const Comparison& comparison, const Hypothesis& best);

/// Whether the size of one of these effects of a fit is larger than so many standard deviations, or whether the several
/// sizes of one (at several places, of each configuration) are together farther from 0 than chance brings them in one
/// of 100 cases. Sizes that clips do not have in common are not looked at and count as certain.
bool has_certain_size(const TrackSet& set, const MotionFit& fit, const std::vector<std::size_t>& effects,
                      double least_sd = 1.0);

/// Whether an effect is a function of the place, whose many sizes follow nearly any motion, and all of them may as well
/// be 0.
bool is_function_without_size(const TrackSet& set, const MotionFit& fit, std::size_t effect);

/// Whether an explanation shifts none of the quantities of the nominal model, K, mu and the inclinations, by more than
/// two standard deviations, of its own fit or of the nominal one, whichever is larger.
bool leaves_quantities(const TrackSet& set, const MotionFit& nominal, const MotionFit& with);

/// If some effects of an explanation have no certain size: the explanation in which others that the data cannot tell
/// from them have one in their place (a cable for a bumper that was barely touched). If none has, the explanation of
/// those with a size alone, since a drag of size 0 beside a wrong frame rate is no cause, unless they leave more of the
/// gap: of two uncertain parameters together the effect can be certain. Nor are those left out that are clearly
/// likelier than what would remain. Null if all have a size, or if there is no such fit.
const Hypothesis* with_certain_sizes(const TrackSet& set, const Comparison& comparison, const Hypothesis& best);

/// What has a certain size in this fit of several effects, as an explanation with a fit of its own. Null if all of them
/// have, or none, if there is no such explanation, or if frames are lost, whose number is certain.
const Hypothesis* part_with_sizes(const TrackSet& set, const MotionFit& fit, const Comparison& comparison);

/// If some of several causes do not take their part, the cause that is clearly likelier keeps its name, rather than the
/// one that takes most in place of both. Returns the explanation with that cause alone; null if the sequence names it
/// already, or if no fit has it alone.
const Hypothesis* without_the_lesser(const Comparison& comparison, bool filmed, const Hypothesis& best,
                                     const CauseSequence& sequence);

/// Whether some explanation by an effect, or by one that no track can tell from it, has more evidence than the nominal
/// model. What differs from clip to clip needs none: the remainder of the nominal model contains it.
bool has_evidence(const Comparison& comparison, std::size_t effect, bool filmed);

/// Whether a verdict may rest on the named causes of a sequence: one of them, the first or a law beside it, takes a
/// tenth of the gap or more and has evidence, unless the noise is negligible, and, unless it is open-ended, a size in
/// the fit that is stated that differs from 0 by two standard deviations.
bool may_lead(const BesideRemainder& sized, const Comparison& comparison, const CauseSequence& sequence);

/// The explanation by the causes that keep their name in a sequence; `best` if it was not weighed by itself.
const Hypothesis& named_by(const Comparison& comparison, const CauseSequence& sequence, const Hypothesis& best);

/// Whether some viscous drag is clearly likelier by the positions alone than any quadratic one and leaves less, each
/// with what acts beside it. Bumpers and cables do not count, since nothing but air touches the body, nor do other laws
/// of the drag of air. `over_viscous` is that of FallsThroughAir.
bool viscous_leaves_less(const TrackSet& set, const Comparison& comparison, std::optional<double> over_viscous);

}  // namespace glidelab::diagnose
