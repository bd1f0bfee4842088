/// The lines of the phase diagram with textbook intervals: ordinary least squares through the smoothed points as if
/// they were independent. Shown beside the estimators so that it is seen to fail: neighbours share the noise under one
/// kernel, so that n points are worth n times (step / kernel width) at most.
#pragma once

#include "core/results.h"

namespace glidelab::validate {

/// The same results with K/m, mu, alpha and v_lim by the naive lines, and estimator = "naive-lines".
core::AnalysisResults with_naive_lines(core::AnalysisResults results);

}  // namespace glidelab::validate
