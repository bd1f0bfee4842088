/// What one clip's images show, in pixels: the marker in every frame, the frames' times, and anything else of note.
#pragma once

#include <opencv2/core.hpp>

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/camera_and_planes.h"
#include "core/pictures/frames/open_frames.h"
#include "core/pictures/marker/marker_track.h"
#include "core/result/picture_record.h"

namespace glidelab::core {

struct SeenClip {
  TrackedMarker marker;
  std::vector<double> frame_t_s;  ///< of all frames
  cv::Size size;                  ///< of the pictures
  std::vector<std::string> notes;
  std::shared_ptr<PictureRecord> pictures;  ///< where they are asked for
  bool dark_marker = false;                 ///< seen as darker than its surroundings, without a colour that says so
};

/// Counts frames over all clips for the progress; clips may be looked at at the same time.
class FrameCounter {
 public:
  FrameCounter(const base::Progress& progress, std::size_t clips) : progress_(progress), clips_(clips) {}
  /// Tells how far all clips are, this clip's share having grown by `share`.
  void add(double share);

 private:
  const base::Progress& progress_;
  std::size_t clips_;
  std::atomic<double> done_ = 0.0;
};

/// Reads the clip once, or twice: a marker without a stated colour is looked for as a bright disc, and, where such a
/// one is hardly seen and a dark one well, as a dark one. With `look_at_scene` there is a PictureRecord. InputError for
/// pictures that cannot be used, NoMarker (marker_track.h) where there is none.
SeenClip see_clip(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter);

}  // namespace glidelab::core
