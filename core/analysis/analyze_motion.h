/// From x(t) to the friction law: smoothing, the free parts of the motion, lines in a(v), and equation (13).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// How a line is fitted: by ordinary least squares as the paper does (line_fit.h), or by generalised least squares with
/// the points' covariance (gls_line.h).
enum class LineMethod { ordinary, generalised };

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

/// Joins clips of one mass, stated inclination and group: lines through the points of all of them, alpha and mu by
/// (13). With generalised lines the clips' own lines are weighed by their inverse covariances.
std::vector<ConfigurationResult> join_configurations(const std::vector<ClipSetup>& setups,
                                                     const std::vector<ClipResult>& clips, double gravity_m_s2,
                                                     LineMethod lines = LineMethod::ordinary);

}  // namespace glidelab::core
