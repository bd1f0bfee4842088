/// Causes in order: each takes what it can of the held-out gap, beside those before it, until none takes more than its
/// uncertainty.
///
///     share_i = (g²_{i-1} - g²_i) / (g²_0 - f²),       g the gap of held-out clips (held_out.h), g_0 of the nominal
///                                                      model, f the floor (floor_of(): 1, or less)
///
/// The causes that a verdict names come first, then others of the list, each fitted in full beside all before it. In
/// both parts the one that takes most is first, and what differs from clip to clip comes after the laws that all clips
/// have in common, since it would take up what these explain. The gap is measured in the position noise alone,
/// whichever remainder the causes were weighed with. Intervals are over clips (gap_sizes.h). A single clip is held out
/// in quarters, and has no interval.
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

struct CauseSequence {
  double gap_before = 1.0, standard_error = 0.0;
  std::vector<ExplainedCause> causes;
  double gap_after = 1.0;
  MotionFit named;  ///< by the noise alone, with the verdict's causes
  double named_share = 0.0;

  bool is_gap = false;  ///< has_gap()
};

/// `set` has the noise alone and `nominal` is its fit; `with` counts a remainder as noise (or is the same), and `named`
/// is a fit to it with the causes that a verdict would name (none: the nominal one). One that takes less than
/// `least_named` of the excess beside those before it is not among the named.
CauseSequence sequence_of(const TrackSet& set, const MotionFit& nominal, const TrackSet& with, const MotionFit& named,
                          const std::set<std::size_t>& without, double least_named);

/// Whether a fit's gap is above its floor by more than kClearGap standard errors.
bool has_gap(const TrackSet& set, const MotionFit& fit);

inline constexpr double kLeastShare = 0.02;  ///< of the excess: nobody would look for a cause of less

/// g² - 1 of a fit to `set`, g the gap of held-out clips, or of the parts of a single one (gap/held_out.h).
double held_out_excess(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
