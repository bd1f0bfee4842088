/// Where a table of lines departs from the usual model: groups of lines whose mean is off by three of its standard
/// deviations or more, the largest first.
///
/// For a group with weights w (each 1/n) the mean of the residuals r = (1 - H) y is w'r, and its standard deviation
/// sqrt(w' (1 - H) w) times the lines' own scatter, H being the usual model's projection.
#pragma once

#include <vector>

#include "diagnose/lines/line_solution.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// Intercepts (m/s²) of each mass, and of each set-up, in one direction; drag K (N s/m) of each mass and of each
/// set-up. None where the lines' own scatter is not known.
std::vector<GapRegion> line_regions(const std::vector<TableLine>& lines, const LineData& data,
                                    const LineSolution& nominal, const OwnScatter& scatter);

/// What the usual model leaves, for the plots.
std::vector<LineOff> lines_off(const std::vector<TableLine>& lines, const LineSolution& nominal);

/// The friction that a single effect on intercepts (a friction force, a smoothing bias) adds to the usual model's as
/// the lines were fitted with it. Nothing for another term.
LineCurve line_curve(const std::vector<TableLine>& lines, const LineData& data, const LineTerm& term,
                     const LineSolution& with);

}  // namespace glidelab::diagnose
