/// A look at a recording before any analysis: is the pattern found, is the marker, are the pictures and times fit for
/// it?
///
/// The pictures pass through the analysis's own functions once (tracks_of: calibration, tracking, restitution); a clip
/// in which no marker of the stated diameter is found is read again for one of another. The tracks
/// pass through its lines a(v), for the direction of the launch and for the inclination, which are laid beside what is
/// stated (statement_findings.h). What cannot be used is a finding here, not an error.
#pragma once

#include "base/progress.h"
#include "core/check/recording_check.h"
#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"

namespace glidelab::core {

/// `jobs` clips at a time. InputError only for an experiment without clips.
RecordingCheck check_recording(const Experiment& experiment, int jobs,
                               const base::Progress& progress = base::no_progress,
                               const FrameOpener& open = open_frames);

/// What the measurements of `check` say, the gravest first; the limits stand in docs/reference/check.md.
std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check);

}  // namespace glidelab::core
