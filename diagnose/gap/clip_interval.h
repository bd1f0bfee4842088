/// 95 % intervals over clips: how much a gap would differ with other clips of the same kind.
///
/// The jackknife: with each clip left out in turn of a pooled number T of n clips (not of the fit again), T_(c),
///
///     se² = (n - 1)/n sum_c (T_(c) - mean)²,      T ± t(0.975, n - 1) se
///
/// A root mean square is taken by its logarithm, so that its interval stays above zero. Clips count as independent of
/// each other, although each one's model comes from the others. Fewer than three clips have no interval: one difference
/// between two tells nothing of the next.
#pragma once

#include <optional>
#include <span>

#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

inline constexpr std::size_t kFewestClips = 3;

/// So many clips, where they are too few for an interval.
std::optional<std::size_t> too_few_clips(std::size_t clips);

/// What a clip adds to a mean square: a sum of squares, and their number.
struct ClipSquares {
  double sum = 0.0;
  double count = 0.0;
};

/// Of sqrt(sum/count) over all clips. None for fewer than three clips that count, nor where one of them is all there
/// is.
std::optional<GapInterval> rms_interval(std::span<const ClipSquares> clips);

/// Of (before - after)/(before - 1), the clips being the same in both. None for fewer than three clips, nor where
/// `before` without one of them is not above 1.
std::optional<GapInterval> shrink_interval(std::span<const ClipSquares> before, std::span<const ClipSquares> after);

}  // namespace glidelab::diagnose
