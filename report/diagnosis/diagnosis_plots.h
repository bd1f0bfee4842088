/// The plots of a diagnosis.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// What a gap lies over, for a reader: "position x (m)".
std::string axis_of(diagnose::GapVariable variable);

/// Labels of a horizontal bar chart, the first one at the top (y = 0, the next at -1): a command of gnuplot.
std::string chart_labels(const std::vector<std::string>& names);

/// Along what a residual lies: its position, speed or time. std::logic_error for any other variable.
const std::vector<double>& along(const diagnose::ResidualCurve& curve, diagnose::GapVariable variable);

/// Probability of each explanation; gap of each held-out clip (of published lines: of each line) before and after,
/// where there is a gap.
std::vector<Plot> verdict_plots(const diagnose::Diagnosis& diagnosis);

/// What is missing as a function of place, speed or time; residuals before and after.
std::vector<Plot> where_plots(const diagnose::Diagnosis& diagnosis);

/// What the images show: the residuals of the calibration over the image, the marker's lengthening over its speed,
/// pixels' noise over their brightness, the light and the scene's place over time. Nothing for tracks.
std::vector<Plot> picture_plots(const diagnose::Diagnosis& diagnosis);

/// Which effects look alike in these data. Nothing where fewer than two can be seen.
std::vector<Plot> isolability_plots(const diagnose::Isolability& isolability);

}  // namespace glidelab::report
