/// The page of a diagnosis of published lines, with its plots. The page of motions does not serve: it speaks of clips,
/// positions and their noise.
#pragma once

#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// The friction that the nominal model leaves in each line's intercept, over 1/m and over (K/m)², with what each effect
/// that acts on intercepts makes of it.
std::vector<Plot> line_plots(const diagnose::LineComparison& lines);

/// A whole page; `diagnosis.lines` is there. EnvironmentError where gnuplot fails.
Page line_report(const std::string& title, const diagnose::Diagnosis& diagnosis);

/// What stands under "lines" in diagnosis.json.
Json lines_json(const diagnose::LineComparison& lines);

/// The explanations as rows of a table of plain text, a header first: those that were weighed, of those without a name
/// the first three.
std::vector<std::vector<std::string>> line_rows(const diagnose::LineComparison& lines);

}  // namespace glidelab::report
