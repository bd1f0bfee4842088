/// A check of a recording before any analysis: are pattern and marker found, are the images and times good enough?
///
/// The images pass once through the functions of the analysis (tracks_of: calibration, tracking, restitution); a clip
/// in which no marker of the stated diameter is found is read again for other sizes. The lines a(v) of the tracks give
/// the direction of the launch and the inclination, which are compared with what is stated (statement_findings.h). What
/// cannot be used is a finding here, not an error.
#pragma once

#include "base/progress.h"
#include "core/check/recording_check.h"
#include "core/experiment/experiment.h"
#include "core/pictures/frames/open_frames.h"

namespace glidelab::core {

/// `jobs` clips at a time. InputError only for an experiment without clips.
RecordingCheck check_recording(const Experiment& experiment, int jobs,
                               const base::Progress& progress = base::no_progress,
                               const FrameOpener& open = open_frames);

}  // namespace glidelab::core
