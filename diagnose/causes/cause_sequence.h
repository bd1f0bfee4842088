/// The causes of a gap in order. Each takes a share of the held-out excess beside those before it, until none takes
/// more than its uncertainty, the gap is at the noise floor, or there are four.
///
///     share_i = (g²_{i-1} - g²_i) / (g²_0 - f²),       g the gap of held-out clips (held_out.h), g_0 of the nominal
///                                                      model, f the floor (floor_of(): 1, or less)
///
/// The causes that a verdict names come first, then others on the list, each fitted in full beside all before it. In
/// both parts the cause that takes most comes first, and effects that differ from clip to clip come after the laws that
/// all clips have in common, since they would absorb what these explain. The gap is measured in units of the position
/// noise alone, whichever remainder the causes were weighed with. The 95 % intervals are over clips (gap_sizes.h). A
/// single clip is held out in quarters and has no interval.
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
  MotionFit named;  ///< fit by the noise alone, with the verdict's causes
  double named_share = 0.0;
  /// Effects in `named` that are no causes of the gap: without them the motion contradicts stated inclinations.
  std::set<std::size_t> by_stated;

  bool is_gap = false;  ///< has_gap()
};

/// `set` has the position noise alone, and `nominal` is the nominal fit to it. `with` counts a remainder as noise (or
/// is the same set), and `named` is a fit to `with` with the causes that a verdict would name, or the nominal fit. A
/// cause that takes less than `least_named` of the excess beside those before it is not among the named ones, unless it
/// takes half of what they leave and that is more than the noise.
CauseSequence sequence_of(const TrackSet& set, const MotionFit& nominal, const TrackSet& with, const MotionFit& named,
                          const std::set<std::size_t>& without, double least_named);

/// Whether a fit's gap is above its floor by more than kClearGap standard errors.
bool has_gap(const TrackSet& set, const MotionFit& fit);

inline constexpr double kLeastShare = 0.02;  ///< of the excess: a smaller share is not worth a cause

/// g² - 1 of a fit to `set`, g the gap of held-out clips or of the held-out quarters of a single clip (gap/held_out.h).
double held_out_excess(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
