/// What the images of one clip show, in pixels: the search for the marker, and the scene behind it.
#pragma once

#include <opencv2/core.hpp>

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/long_work.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_track.h"
#include "core/result/analysis_note.h"
#include "core/result/image_record.h"

namespace glidelab::core {

/// What one clip's images show, in pixels: the marker in every frame, the frames' times, and anything else of note.
struct SeenClip {
  TrackedMarker marker;
  std::vector<double> frame_t_s;        ///< of all frames
  cv::Size size;                        ///< of the images
  std::vector<Note> notes;              ///< about the file; the marker has its own notes
  std::shared_ptr<ImageRecord> images;  ///< if requested
  bool dark_marker = false;             ///< seen as darker than its surroundings, with no stated colour
  std::optional<bool> predicted;        ///< whether a lossy codec predicts images from earlier ones; empty if not known
};

/// Counts frames over all clips for the progress; clips may be processed concurrently.
class FrameCounter {
 public:
  FrameCounter(const base::Progress& progress, std::size_t clips) : progress_(progress), clips_(clips) {}
  /// Reports the progress over all clips, this clip's share having grown by `share`.
  void add(double share);

 private:
  const base::Progress& progress_;
  std::size_t clips_;
  std::atomic<double> done_ = 0.0;
};

/// How far the search for the marker goes.
enum class MarkerSearch {
  thorough,  ///< as a disc, as a sphere that is lit from one side, by its own look
  disc       ///< the first of these alone, which takes less time where there is no marker
};

/// Reads the clip once or twice: a marker without a stated colour is searched for as a bright disc and, if a bright one
/// is hardly seen but a dark one well, as a dark disc. With `look_at_scene` there is a ImageRecord. InputError for
/// images that cannot be used, NoMarker (marker_track.h) if there is no marker.
SeenClip see_clip(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter,
                  MarkerSearch search = MarkerSearch::thorough);

}  // namespace glidelab::core
