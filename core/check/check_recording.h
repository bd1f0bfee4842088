/// A check of a recording before any analysis: are pattern and marker found, are the images and times good enough?
///
/// The images pass once through the functions of the analysis (tracks_of: calibration, tracking, restitution). A clip
/// in which no marker of the stated diameter is found is read again for other sizes. The lines a(v) of the tracks give
/// the direction of the launch and the inclination, which are compared with what is stated (statement_findings.h). What
/// cannot be used is a finding here, not an error.
#pragma once

#include <optional>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/preview.h"
#include "core/check/check_result.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {

struct CheckedPattern {
  PatternCheck check;
  std::optional<SeenPattern> seen;  ///< the corners and the camera, if there is one
};

/// The images of the pattern: in which of them it is found, how well one camera explains them, how much of the image
/// they cover. For an experiment with [calibration]; images are read `jobs` at a time. check.failure says what is wrong
/// with them.
CheckedPattern check_pattern(const Experiment& experiment, int jobs,
                             const base::Progress& progress = base::no_progress);

/// The share of a path that lies within the convex hull of all corners, if the lens is known; empty for an empty path
/// or fewer than three corners.
std::optional<double> share_inside(const PatternCheck& pattern, const std::vector<PixelPlace>& path);

/// `jobs` clips at a time. InputError only for an experiment without clips.
RecordingCheck check_recording(const Experiment& experiment, int jobs,
                               const base::Progress& progress = base::no_progress,
                               const FrameOpener& open = open_frames);

/// One frame of every clip in which the marker was seen, for a page.
std::vector<Preview> previews_of_check(const Experiment& experiment, const RecordingCheck& check);

}  // namespace glidelab::core
