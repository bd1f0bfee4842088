/// Experiment folders in, a diagnosis out.
///
///     folders ─ core's analysis ─ track_set ─ hypotheses (motion_fit, effect_scan, unnamed) ─ held_out ─ Diagnosis
///
/// What the analysis took for a hand or a stop is first tried as part of the motion. If no effect on the list explains
/// it, it is left out, and a note says so (settled_motions.h).
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
  std::vector<std::string> without;  ///< ids of effects that are not considered
  int jobs = 1;
  bool twin = false;                 ///< whether the twin gets the camera that the folders describe, if they do
  core::TrackFileOptions bare = {};  ///< how bare track files are read, and whether a folder may name files outside it
};

/// The diagnosis of the experiment in these folders, or of one table of lines. InputError for a faulty folder, for data
/// that allow no verdict (too few positions, no free motion), for a table of lines beside other folders, and for an
/// unknown effect in `without`. A clip without a marker is left out and named (Diagnosis::left_out), unless all are.
Diagnosis diagnose(const std::vector<std::filesystem::path>& folders, const DiagnoseOptions& options,
                   const base::Progress& progress = base::no_progress);

/// The analysis on which a diagnosis rests: with times as stated, and with what the images of the clips show.
/// InputError, before anything is analysed, for a file whose x is a height while no inclination is stated.
core::AnalysisResults analyze_for_diagnosis(const std::vector<std::filesystem::path>& folders,
                                            const DiagnoseOptions& options,
                                            const base::Progress& progress = base::no_progress,
                                            core::WithoutMarker without = core::WithoutMarker::an_error);

/// The same from such an analysis. `setups` are the clips of all folders in order. `cameras` is what is stated of each
/// clip's camera; without it, the images do not count. `folders` is what else the folders state, for a twin's camera.
Diagnosis diagnose_results(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                           const DiagnoseOptions& options, const base::Progress& progress = base::no_progress,
                           const std::vector<std::optional<core::CameraSettings>>& cameras = {},
                           const std::vector<core::Experiment>& folders = {});

}  // namespace glidelab::diagnose
