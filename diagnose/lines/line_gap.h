/// How far a table's lines lie off an explanation, each held out of it in turn; how far their inclinations lie off what
/// is stated; and where lines depart from the nominal model.
///
/// Regions are groups of lines whose mean is off by three of its standard deviations or more, the largest first. For a
/// group with weights w (each 1/n) the mean of the residuals r = (1 - H) y is w'r, and its standard deviation
/// sqrt(w' (1 - H) w) times the lines' own scatter, H being the nominal model's projection.
#pragma once

#include <vector>

#include "diagnose/lines/line_solution.h"
#include "diagnose/lines/line_table.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct LineGap {
  GapSizes sizes;
  std::vector<Note> notes;  ///< of the inclinations
};

/// `before`: the fit of the nominal model; `after`: that of the explanation. The lines' own scatter, which is known, is
/// the unit of the gap; the stated inclination is compared with the mean intercept, asin(a0 / g).
LineGap line_gap(const std::vector<TableLine>& lines, double g, const LineSolution& before, const LineSolution& after,
                 const OwnScatter& scatter);

/// Intercepts (m/s²) of each mass, and of each set-up, in one direction; drag K (N s/m) of each mass and of each
/// set-up. None where the lines' own scatter is not known.
std::vector<GapRegion> line_regions(const std::vector<TableLine>& lines, const LineData& data,
                                    const LineSolution& nominal, const OwnScatter& scatter);

/// What the nominal model leaves, for the plots.
std::vector<LineOff> lines_off(const std::vector<TableLine>& lines, const LineSolution& nominal);

/// The friction that a single effect on intercepts (a friction force, a smoothing bias) adds to the nominal model's, as
/// the lines were fitted with it. Nothing for another term.
LineCurve line_curve(const std::vector<TableLine>& lines, const LineData& data, const LineTerm& term,
                     const LineSolution& with);

}  // namespace glidelab::diagnose
