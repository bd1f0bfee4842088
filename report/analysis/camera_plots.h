/// What a camera's images leave that its model does not have: the calibration's residuals over the image, and pixels'
/// noise over their brightness.
#pragma once

#include <string>
#include <vector>

#include "core/result/results.h"
#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// Mean residuals of the pattern's corners in cells of the image, as arrows; nothing if there are none. `experiment`
/// is named where there are several.
std::vector<Plot> calibration_plots(const core::CornerMap& rests, const std::string& experiment);

/// A curve `noise` (diagnosis.h).
Plot noise_plot(const diagnose::PictureCurve& curve);

/// Root mean square of a curve's distances from what was fitted, over their standard deviations.
double curve_excess(const diagnose::PictureCurve& curve);

}  // namespace glidelab::report
