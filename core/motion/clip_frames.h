/// A clip frame by frame, as it is reported: smoothed, with the fate of each frame, and the stretches that are used.
#pragma once

#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/lines/stretch_points.h"
#include "core/motion/smoothing/noise.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// What is known of a clip once its points are smoothed.
struct SmoothedClip {
  const TrackData& track;
  const Motion& motion;  ///< of the track, without its outliers
  const FreeMotion& free;
  const PositionNoise& noise;
  const std::vector<StretchPoint>& points;  ///< of the free stretches
  double bandwidth_s = 0.0;
  double mass_kg = 0.0;
};

/// Every frame of the clip, smoothed with the points of its own stretch, or of what lies between two of them; and why
/// it does not count, where it does not.
std::vector<MotionPoint> frames_of(const SmoothedClip& clip);

/// The track's shared errors, of every frame; 0 without a marker.
std::vector<std::vector<double>> shared_of_frames(const TrackData& track);

/// Frames in a row that are left out for one reason.
std::vector<LeftOutInterval> intervals_of(const std::vector<MotionPoint>& frames);

/// The stretches that have points which count.
std::vector<Stretch> used_stretches(const SmoothedClip& clip);

}  // namespace glidelab::core
