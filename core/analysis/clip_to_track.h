/// From images to x(t) of every clip: what a clip's images show in pixels, and the corresponding positions along the
/// line of motion. One function per folder, tracks_of(), hides everything that concerns images.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/see_clip.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_fit.h"
#include "core/pictures/marker/marker_track.h"
#include "core/result/image_record.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// What the images of a folder show.
struct ImageResults {
  std::vector<TrackData> tracks;             ///< one for each clip, in the experiment's order
  std::vector<std::vector<MarkerFit>> fits;  ///< one for each clip: the marker's image wherever it was seen, frames
                                             ///< rise
  std::optional<CalibrationResult> calibration;
  std::vector<PlumbResult> plumbs;
  /// Independent errors of camera, planes and codec: the largest number of entries in any track's shared_m.
  std::size_t modes = 0;
  std::vector<std::optional<MarkerNotFound>> without_marker;  ///< one for each clip; its track is empty then
};

/// Calibrates, tracks the marker in every clip, restitutes it to the plane of motion and projects it onto the line of
/// motion, x positive downhill. Clips that are tracks are read with read_track. Frames stream; `jobs` clips at a time.
/// A marker whose outlines are those of a disc in the plane of motion is restituted as one, else as a sphere. With
/// `look_at_scene` every track has its ImageRecord. `seen_pattern`: what is already known about the pattern
/// (restitution.h); null: its images are read. `without`: what becomes of a clip without a marker. InputError for
/// images that cannot be used (no pattern, no marker, truncated, of another size, …).
ImageResults tracks_of(const Experiment& experiment, int jobs, const base::Progress& progress = base::no_progress,
                       const FrameOpener& open = open_frames, bool look_at_scene = false,
                       const SeenPattern* seen_pattern = nullptr, MarkerSearch search = MarkerSearch::thorough,
                       WithoutMarker without = WithoutMarker::an_error);

}  // namespace glidelab::core
