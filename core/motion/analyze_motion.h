/// From x(t) to the friction law: smoothing, the free parts of the motion, lines in a(v), and equation (13).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/result/line_method.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// Whether times are put right by the frames that the motion shows to be lost (lost_frames.h).
enum class LostFrameTimes { put_right, kept };

struct MotionOptions {
  std::optional<double> bandwidth_s = {};  ///< given; otherwise chosen
  std::string bandwidth_rule = {};         ///< a name of bandwidth_rule.h (asserted); empty: choose_bandwidth()
  LineMethod lines = LineMethod::ordinary;
  LostFrameTimes lost_frames = LostFrameTimes::put_right;
};

/// Smooths one clip's x(t) with the local cubic (10)-(12), decides which points count, and fits a line for v < 0 and v
/// > 0. A given bandwidth is used as it is; otherwise the rule named, or choose_bandwidth(), decides.
ClipResult analyze_motion(const ClipSetup& setup, const TrackData& track, const MotionOptions& options);

}  // namespace glidelab::core
