/// From images to x(t) of every clip: what a clip's images show in pixels, and the corresponding positions along the
/// line of motion. One function per folder, tracks_of(), hides everything that concerns images.
#pragma once

#include <opencv2/core.hpp>

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker.h"
#include "core/pictures/marker/marker_track.h"
#include "core/result/picture_record.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// What one clip's images show, in pixels: the marker in every frame, the frames' times, and anything else of note.
struct SeenClip {
  TrackedMarker marker;
  std::vector<double> frame_t_s;            ///< of all frames
  cv::Size size;                            ///< of the images
  std::vector<Note> notes;                  ///< about the file; the marker has its own notes
  std::shared_ptr<PictureRecord> pictures;  ///< if requested
  bool dark_marker = false;                 ///< seen as darker than its surroundings, with no stated colour
  std::optional<bool> predicted;  ///< whether a lossy codec predicts images from earlier ones; empty if not known
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
  disc       ///< the first of these alone: a tenth of the time where there is no marker
};

/// Reads the clip once or twice: a marker without a stated colour is searched for as a bright disc and, if a bright one
/// is hardly seen but a dark one well, as a dark disc. With `look_at_scene` there is a PictureRecord. InputError for
/// images that cannot be used, NoMarker (marker_track.h) if there is no marker.
SeenClip see_clip(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter,
                  MarkerSearch search = MarkerSearch::thorough);

struct SeenPattern;

/// What the images of a folder show besides the motion.
struct PictureResults {
  std::vector<TrackData> tracks;             ///< one for each clip, in the experiment's order
  std::vector<std::vector<MarkerFit>> fits;  ///< one for each clip: the marker's image wherever it was seen, frames
                                             ///< rise
  std::optional<CalibrationResult> calibration;
  std::vector<PlumbResult> plumbs;
  std::size_t modes =
      0;  ///< independent errors of camera, planes and codec: maximum number of entries in every track's shared_m
};

/// Calibrates, tracks the marker in every clip, restitutes it to the plane of motion and projects it onto the line of
/// motion, x positive downhill. Clips that are tracks are read with read_track. Frames stream; `jobs` clips at a time.
/// A marker whose outlines are those of a disc in the plane of motion is restituted as one, else as a sphere. With
/// `look_at_scene` every track has its PictureRecord. `seen_pattern`: what is already known about the pattern
/// (restitution.h); null: its images are read. InputError for images that cannot be used (no pattern, no marker,
/// truncated, of another size, …).
PictureResults tracks_of(const Experiment& experiment, int jobs, const base::Progress& progress = base::no_progress,
                         const FrameOpener& open = open_frames, bool look_at_scene = false,
                         const SeenPattern* seen_pattern = nullptr, MarkerSearch search = MarkerSearch::thorough);

}  // namespace glidelab::core
