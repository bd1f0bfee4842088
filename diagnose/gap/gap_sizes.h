/// How large the gap is in each domain, before and after, with 95 % intervals over clips.
///
/// The domains are positions (held_out.h), phase plane and parameters (domain_gaps.h) and images.
///
/// An interval says how much a gap would differ with other clips of the same kind. It is a jackknife: with T_(c) a
/// pooled number T of n clips from which clip c is left out (not out of the fit),
///
///     se² = (n - 1)/n sum_c (T_(c) - mean)²,      T ± t(0.975, n - 1) se.
///
/// For a root mean square the interval is that of its logarithm, so that it stays above zero. Clips count as
/// independent of each other, although each one's model comes from the others. Fewer than three clips have no interval,
/// since the one difference between two clips says nothing about a third.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

inline constexpr std::size_t kFewestClips = 3;

/// The number of clips, if it is too small for an interval.
std::optional<std::size_t> too_few_clips(std::size_t clips);

/// What a clip contributes to a mean square: a sum of squares, and their number.
struct ClipSquares {
  double sum = 0.0;
  double count = 0.0;
};

/// The interval of sqrt(sum/count) over all clips. None if fewer than three clips count, or if a single one contributes
/// everything.
std::optional<GapInterval> rms_interval(std::span<const ClipSquares> clips);

/// 1, or the gap that the best fit leaves if that is clearly below 1: noise is estimated from neighbouring positions,
/// and a wave of a few frames looks like noise until a cause removes it. No residual is smaller than the noise.
double floor_of(double gap_after, double standard_error);

/// The interval of (before - after)/(before - floor), with the same clips in both. None for fewer than three clips, or
/// if `before` without one of them is not above the floor.
std::optional<GapInterval> shrink_interval(std::span<const ClipSquares> before, std::span<const ClipSquares> after,
                                           double floor = 1.0);

/// The interval of (before - after)/(first - floor), in squares of the gaps, with the same clips in all three. None for
/// fewer than three clips, or if `first` without one of them is not above the floor.
std::optional<GapInterval> share_interval(std::span<const ClipSquares> first, std::span<const ClipSquares> before,
                                          std::span<const ClipSquares> after, double floor = 1.0);

/// The gap of held-out clips, for the nominal fit and for the best one, with intervals over clips. `best` has a named
/// effect, the likeliest function without a name (`unnamed`), or nothing more. For a single clip, stretches are held
/// out, and a note says so. The domains are left empty.
GapSizes gap_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best, bool unnamed,
                std::vector<Note>& notes);

/// Each domain that the data have. Positions: the gap of held-out clips. Phase plane and parameters: the root mean
/// square of the differences over their standard deviations. Images: sqrt(2 log evidence) of the effect that shows
/// most, and at least 1; after: of the most visible effect that is not named. What a file states about itself does not
/// count.
std::vector<GapDomain> gap_domains(const GapSizes& gap, const std::vector<ImageFinding>& images,
                                   const std::vector<DiagnosedEffect>& named);

/// About 250 residuals of every motion, of both fits to all clips, in metres.
std::vector<ResidualCurve> residuals_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best);

/// Whether the law holds within configurations but not across them: the excess (the squared gap minus its floor, 1)
/// within configurations is less than 15 % of that of all together.
bool holds_within(double gap_within, double gap_of_all);

}  // namespace glidelab::diagnose
