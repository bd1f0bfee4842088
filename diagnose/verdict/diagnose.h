/// Experiment folders in, a diagnosis out.
///
///     folders ─ core's analysis ─ track_set ─ hypotheses (motion_fit, effect_scan, unnamed) ─ held_out ─ Diagnosis
///
/// What the analysis took for a hand or a stop is first tried as part of the motion; where no effect on the list
/// explains it, it is left out, and a note says so (settled_motions.h).
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/long_work.h"
#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "core/track/bare_track.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct DiagnoseOptions {
  std::vector<std::string> without;  ///< effects that are not considered
  int jobs = 1;
  bool twin = false;  ///< a twin is wanted, with the camera that the folders describe, or else a scenario's own
  core::TrackFileOptions bare = {};  ///< for inputs that are track files, and whether a folder may name files outside
};

/// InputError for a faulty folder, for data that allow no verdict (too few positions, no free motion), and for an
/// unknown effect in `without`.
Diagnosis diagnose(const std::vector<std::filesystem::path>& folders, const DiagnoseOptions& options,
                   const base::Progress& progress = base::no_progress);

/// The analysis that a diagnosis is made from: times as they are stated, and what the clips' images show.
core::AnalysisResults analyze_for_diagnosis(const std::vector<std::filesystem::path>& folders,
                                            const DiagnoseOptions& options,
                                            const base::Progress& progress = base::no_progress);

/// The same from an analysis that was made already; `setups` are all folders' clips in order, `cameras` what is stated
/// of each clip's camera (needed where the analysis kept the pictures), `folders` what else they state (for a twin's
/// camera; without them it is a scenario's own).
Diagnosis diagnose_results(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                           const DiagnoseOptions& options, const base::Progress& progress = base::no_progress,
                           const std::vector<std::optional<core::CameraSettings>>& cameras = {},
                           const std::vector<core::Experiment>& folders = {});

}  // namespace glidelab::diagnose
