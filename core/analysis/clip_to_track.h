/// From images to x(t): one function per folder hides everything that has to do with images.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/progress.h"
#include "core/experiment/experiment.h"
#include "core/pictures/frames/open_frames.h"
#include "core/pictures/marker/marker.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

struct SeenPattern;

/// What the pictures of a folder say besides the motion.
struct PictureResults {
  std::vector<TrackData> tracks;             ///< one for each clip, in the experiment's order
  std::vector<std::vector<MarkerFit>> fits;  ///< as many: the marker's image wherever it was seen, frames rise
  std::optional<CalibrationResult> calibration;
  std::vector<PlumbResult> plumbs;
  std::size_t modes = 0;  ///< independent errors of camera and planes: entries of every track's shared_m, at most
};

/// Calibrates, tracks the marker in every clip, restitutes it to the plane of motion and projects it on the line of
/// motion, x positive downhill. Clips that are tracks (CSV) are read with read_track_csv. Frames stream; `jobs` clips
/// at a time. With `look_at_scene` every track has its PictureRecord. `seen_pattern`: what is known of the pattern
/// already (camera_and_planes.h); null: its pictures are read. InputError for pictures that cannot be used (no pattern,
/// no marker, truncated, of another size, …).
PictureResults tracks_of(const Experiment& experiment, int jobs, const base::Progress& progress = base::no_progress,
                         const FrameOpener& open = open_frames, bool look_at_scene = false,
                         const SeenPattern* seen_pattern = nullptr);

}  // namespace glidelab::core
