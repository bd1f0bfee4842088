/// From pictures to x(t): everything that has to do with images, behind one function a folder.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "core/experiment.h"
#include "core/frame_source.h"
#include "core/results.h"
#include "core/track_data.h"

namespace glidelab::core {

/// What the pictures of a folder say besides the motion.
struct PictureResults {
  std::vector<TrackData> tracks;  ///< one for each clip, in the experiment's order
  std::optional<CalibrationResult> calibration;
  std::vector<PlumbResult> plumbs;
  std::size_t modes = 0;  ///< independent errors of camera and planes: entries of every track's shared_m, at most
};

/// Calibrates, tracks the marker in every clip, restitutes it to the plane of motion and projects it on the line of
/// motion, x positive downhill. Clips that are tracks (CSV) are read with read_track_csv. Frames stream; `jobs` clips
/// at a time. With `look_at_scene` every track has its PictureRecord. InputError for pictures that cannot be used (no
/// pattern, no marker, truncated, of another size, …).
PictureResults tracks_of(const Experiment& experiment, int jobs, const base::Progress& progress = base::no_progress,
                         const FrameOpener& open = open_frames, bool look_at_scene = false);

}  // namespace glidelab::core
