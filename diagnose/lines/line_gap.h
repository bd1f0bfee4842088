/// How far a table's lines lie off an explanation, each held out of it in turn, and how far their inclinations lie off
/// what is stated.
#pragma once

#include <string>
#include <vector>

#include "diagnose/lines/line_solution.h"
#include "diagnose/lines/line_table.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct LineGap {
  GapSizes sizes;
  std::vector<std::string> notes;  ///< of the inclinations
};

/// `before`: the fit with nothing but the simple law; `after`: that of the explanation. The lines' own scatter, which
/// is known, is the unit of the gap; the stated inclination is compared with the mean intercept, asin(a0 / g).
LineGap line_gap(const std::vector<TableLine>& lines, double g, const LineSolution& before, const LineSolution& after,
                 const OwnScatter& scatter);

}  // namespace glidelab::diagnose
