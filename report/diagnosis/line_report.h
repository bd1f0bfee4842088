/// The page of a diagnosis of published lines, with its plots. The page for motions is not suitable: it is about clips,
/// positions and their noise.
#pragma once

#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// The friction that the nominal model leaves in each line's intercept, against 1/m and against (K/m)², with the
/// prediction of each effect that acts on intercepts.
std::vector<Plot> line_plots(const diagnose::LineComparison& lines);

/// A whole page; `diagnosis.lines` must be set. EnvironmentError if gnuplot fails.
Page line_report(const std::string& title, const diagnose::Diagnosis& diagnosis);

/// The entry "lines" of diagnosis.json.
Json lines_json(const diagnose::LineComparison& lines);

/// The explanations as rows of a plain-text table, with a header first: those that were weighed, and of those without a
/// name the first three.
std::vector<std::vector<std::string>> line_rows(const diagnose::LineComparison& lines);

}  // namespace glidelab::report
