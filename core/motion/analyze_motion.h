/// The motion of one clip, from x(t) to the friction law: smoothing, the free parts of the motion, lines in a(v), and
/// mu and alpha from their intercepts; and the report of the clip frame by frame, with the fate of each frame and the
/// stretches used.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/lines/line_fit.h"
#include "core/motion/smoothing/noise.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// What is known about a clip once its points are smoothed.
struct SmoothedClip {
  const TrackData& track;
  const Motion& motion;  ///< of the track, without its outliers
  const FreeMotion& free;
  const PositionNoise& noise;
  const std::vector<StretchPoint>& points;  ///< of the free stretches
  double bandwidth_s = 0.0;
  double mass_kg = 0.0;
};

/// Every frame of the clip, smoothed with the points of its own stretch or of the gap between two stretches, and the
/// reason if it does not count.
std::vector<MotionPoint> frames_of(const SmoothedClip& clip);
/// The same for frames that are already smoothed.
std::vector<MotionPoint> frames_of(const SmoothedClip& clip, std::vector<MotionPoint> smoothed);

/// The track's shared errors at every frame; 0 without a marker.
std::vector<std::vector<double>> shared_of_frames(const TrackData& track);

/// Consecutive frames left out for the same reason.
std::vector<LeftOutInterval> intervals_of(const std::vector<MotionPoint>& frames);

/// The stretches with points that count.
std::vector<Stretch> used_stretches(const SmoothedClip& clip);

/// Whether times are corrected for lost frames that the motion reveals (lost_frames.h).
enum class LostFrameTimes { put_right, kept };

struct MotionOptions {
  std::optional<double> bandwidth_s = {};  ///< given; otherwise chosen
  std::string bandwidth_rule = {};         ///< a name of bandwidth_rule.h (asserted); empty: choose_bandwidth()
  LineMethod lines = LineMethod::ordinary;
  LostFrameTimes lost_frames = LostFrameTimes::put_right;
  std::string smoother = "local-polynomial";  ///< a name of smoother_list.h (asserted)
};

/// InputError for an unknown smoother, and if a smoother without a bandwidth is combined with an option that needs one:
/// a bandwidth, a rule that chooses one, generalised lines.
void check_smoothing(const MotionOptions& options);

/// Smooths one clip's x(t), decides which points count, and fits a line for v < 0 and one for v > 0. A given bandwidth
/// is used (InputError if it is longer than the clip); otherwise the named rule or choose_bandwidth() chooses it. Not
/// for a track of speeds (asserted): speed_motion.h.
ClipResult analyze_motion(const ClipSetup& setup, const TrackData& track, const MotionOptions& options);

}  // namespace glidelab::core
