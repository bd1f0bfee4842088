/// Effects that single frames show: timing jitter, outliers among the positions (and missing_frames.h).
///
/// They are judged by the residuals about a smooth curve through each motion's residuals, so that a force that the
/// model lacks is not taken for them.
#pragma once

#include <optional>

#include "diagnose/scan/effect_scan.h"

namespace glidelab::diagnose {

/// Errors that come together: in the first frames of the clips, or one after the other in one clip (the largest such).
struct ErrorRun {
  std::optional<std::size_t> clip;  ///< none: the first frames of all
  double from_s = 0.0, to_s = 0.0;
  double size_m = 0.0;
  double excess = 0.0;  ///< size over the noise of its position
};

struct FrameEffect {
  std::size_t effect = 0;
  double gain = 0.0;
  double log_evidence = 0.0;
  double value = 0.0;  ///< fraction of frames, or seconds
  double sd = 0.0;
  bool visible = true;               ///< false: too few positions to show it at any size
  double in_runs = 0.0;              ///< log evidence that such frames come together, against chance
  std::optional<ErrorRun> run = {};  ///< the largest, if in_runs is above 0
};

/// Scatter that grows with the speed: variance sd² + (v tau)².
FrameEffect scan_jitter(const TrackSet& set, const MotionFit& fit);

/// A fraction of positions with a scatter many times that of the others. If these follow each other on one side, or
/// come in the first three frames of the clips, this is not scatter but something that lasts, or a tracker that has yet
/// to find its marker: with k of m such frames and a chance p of that,
///
///     in_runs = log B(k + 1, m - k + 1) - k log(p) - (m - k) log(1 - p),
///
/// all other chances being equally likely a priori (the larger of the two); 0 if fewer than four, or less than a
/// quarter of them, are such.
FrameEffect scan_tails(const TrackSet& set, const MotionFit& fit);

/// If the scatter has such tails beyond doubt, the positions that more likely belong to them than not become outliers,
/// so that no force is fitted to them. Returns how many.
std::size_t set_tails_aside(TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
