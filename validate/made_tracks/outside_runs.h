/// An outside estimator (fit/outside/outside_estimator.h) applied to the data of a study: the folder that it gets.
///
/// The folder lies alone in a temporary one, with no truth beside it. Like any experiment folder it contains
/// experiment.toml and
///
///     tracks/NAME.csv   t_s,x_m: the positions of every clip, as made or as measured by Glidelab
///     clips/, …         if filmed: everything that render writes; experiment.toml then names these
///
/// so that an estimator of positions reads tracks/NAME.csv in either case. All digits of the numbers are written.
#pragma once

#include <filesystem>

#include "core/result/results.h"
#include "fit/outside/outside_estimator.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::validate {

/// experiment.toml and tracks/*.csv; the folder is made.
void write_track_folder(const MadeTracks& made, const std::filesystem::path& folder);

/// Adds tracks/*.csv to the folder: for every clip, the positions measured by an analysis.
void write_measured_tracks(const core::AnalysisResults& measured, const std::filesystem::path& folder);

/// Errors as in run_outside().
fit::OutsideOutcome run_outside_on_tracks(const fit::OutsideEstimator& estimator, const MadeTracks& made);

/// Runs on a copy of a filmed folder, with the positions measured by its analysis.
fit::OutsideOutcome run_outside_on_film(const fit::OutsideEstimator& estimator, const std::filesystem::path& folder,
                                        const core::AnalysisResults& measured);

}  // namespace glidelab::validate
