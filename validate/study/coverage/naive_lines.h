/// The lines of the phase diagram with textbook intervals: ordinary least squares through the smoothed points as if
/// they were independent. Shown beside the estimators to demonstrate the failure: neighbours share the noise under one
/// kernel, so n points are worth at most n times (step / kernel width) independent ones.
#pragma once

#include "core/result/results.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::validate {

/// Their name among the estimators. They serve as a contrast; their intervals are not expected to be right.
inline constexpr const char* kNaiveLines = "naive-lines";

/// The same results with K/m, mu, alpha and v_lim by the naive lines, and estimator = kNaiveLines.
core::AnalysisResults with_naive_lines(core::AnalysisResults results);

/// The estimator name of lines_through_all_points(), requested by a sweep of masses.
inline constexpr const char* kAllPoints = "all-points";

/// The same lines through every point of every clip: one kernel of that bandwidth (above 0) over the whole motion, so
/// that it reaches over ends and reversals, and nothing is left out. This is what a(v) looks like if ends and reversals
/// are ignored; a clip's `segments` hold its own lines with R². NumericalError if a kernel holds too few points.
core::AnalysisResults lines_through_all_points(const MadeTracks& made, double bandwidth_s);

}  // namespace glidelab::validate
