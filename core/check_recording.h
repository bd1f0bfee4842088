/// A look at a recording before any analysis: is the pattern found, is the marker, are the pictures and times fit for
/// it?
///
/// The pictures pass through the analysis's own functions once (tracks_of: calibration, tracking, restitution), and the
/// tracks through its first smoothing, for the direction of the launch (free_motion.h); no law is sought. What cannot
/// be used is a finding here, not an error.
#pragma once

#include "base/progress.h"
#include "core/experiment.h"
#include "core/frame_source.h"
#include "core/recording_check.h"

namespace glidelab::core {

/// `jobs` clips at a time. InputError only for an experiment without clips.
RecordingCheck check_recording(const Experiment& experiment, int jobs,
                               const base::Progress& progress = base::no_progress,
                               const FrameOpener& open = open_frames);

/// What the measurements of `check` say, the gravest first; the limits stand in docs/check.md.
std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check);

}  // namespace glidelab::core
