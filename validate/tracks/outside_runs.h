/// An outside estimator (fit/outside/outside_estimator.h) on what a study made: the folder that it gets.
///
/// The folder lies by itself in a temporary one, and no truth lies beside it. In the form of any experiment folder it
/// holds experiment.toml and
///
///     tracks/NAME.csv   t_s,x_m: the positions of every clip, as made or as measured by Glidelab
///     clips/, …         where it was filmed: all that render writes; experiment.toml then names these
///
/// so that an estimator of positions reads tracks/NAME.csv in either case. All digits of the numbers are written.
#pragma once

#include <filesystem>

#include "core/result/results.h"
#include "fit/outside/outside_estimator.h"
#include "validate/tracks/made_tracks.h"

namespace glidelab::validate {

/// experiment.toml and tracks/*.csv; the folder is made.
void write_track_folder(const MadeTracks& made, const std::filesystem::path& folder);

/// tracks/*.csv, of every clip the positions that an analysis has measured, beside what the folder holds.
void write_measured_tracks(const core::AnalysisResults& measured, const std::filesystem::path& folder);

/// Errors as run_outside().
fit::OutsideOutcome run_outside_on_tracks(const fit::OutsideEstimator& estimator, const MadeTracks& made);

/// On a copy of a filmed folder, with the positions that its analysis has measured.
fit::OutsideOutcome run_outside_on_film(const fit::OutsideEstimator& estimator, const std::filesystem::path& folder,
                                        const core::AnalysisResults& measured);

}  // namespace glidelab::validate
