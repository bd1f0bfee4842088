/// The pictures of a diagnosis.
#pragma once

#include <vector>

#include "diagnose/diagnosis.h"
#include "report/plot.h"

namespace glidelab::report {

/// Gap of each held-out clip before and after; probability of each explanation.
std::vector<Plot> verdict_plots(const diagnose::Diagnosis& diagnosis);

/// What is missing as a function of place, speed or time; residuals before and after.
std::vector<Plot> where_plots(const diagnose::Diagnosis& diagnosis);

/// Which effects look alike in these data. Nothing where fewer than two can be seen.
/// The marker's lengthening over its speed, the light and the scene's place over time; none for tracks.
std::vector<Plot> picture_plots(const diagnose::Diagnosis& diagnosis);

std::vector<Plot> isolability_plots(const diagnose::Isolability& isolability);

}  // namespace glidelab::report
