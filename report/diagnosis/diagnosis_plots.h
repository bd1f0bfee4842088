/// The plots of a diagnosis.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// The axis label of a gap's variable: "position x (m)".
std::string axis_of(diagnose::GapVariable variable);

/// Labels of a horizontal bar chart, the first one at the top (y = 0, the next at -1): a command of gnuplot.
std::string chart_labels(const std::vector<std::string>& names);

/// The variable along which a residual lies: its position, speed or time. std::logic_error for any other variable.
const std::vector<double>& along(const diagnose::ResidualCurve& curve, diagnose::GapVariable variable);

/// Probability of each explanation; gap of each held-out clip (for published lines: of each line) before and after, if
/// there is a gap.
std::vector<Plot> verdict_plots(const diagnose::Diagnosis& diagnosis);

/// The missing term as a function of position, speed or time; residuals before and after.
std::vector<Plot> where_plots(const diagnose::Diagnosis& diagnosis);

/// What the images show: the residuals of the calibration over the image, how the marker lengthens with its
/// speed, pixel noise against brightness, the light and the scene's position against time. Empty for tracks.
std::vector<Plot> image_plots(const diagnose::Diagnosis& diagnosis);

/// Which effects look alike in these data. Empty if fewer than two can be seen.
std::vector<Plot> isolability_plots(const diagnose::Isolability& isolability);

}  // namespace glidelab::report
