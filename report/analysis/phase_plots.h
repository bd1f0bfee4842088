/// a(v) diagrams as the paper's figures 6 to 9: points of all masses on one stated inclination, their lines, and the
/// gap at v = 0.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/result/results.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// The configurations of one stated inclination: what one diagram shows.
struct PhaseGroup {
  double incline_deg = 0.0;
  std::vector<std::size_t> configurations;  ///< indices into the results
};
/// One for each stated inclination, in the order in which they first occur.
std::vector<PhaseGroup> phase_groups(const core::AnalysisResults& results);

/// "335 g", with the name of its group where another configuration of the diagram has the same mass.
std::string configuration_label(const core::AnalysisResults& results, const PhaseGroup& group,
                                std::size_t configuration);

/// Half of the 95 % interval of a line at v, in m/s²: t sqrt(var(a0) - 2 v cov(K/m, a0) + v² var(K/m)), with the t of
/// the line's own intervals; 0 of a line without errors.
double line_half95_m_s2(const core::LineFit& line, double v_m_s);

/// The diagram, its detail near v = 0, and the residuals of the lines, each with the lines' 95 % bands and the bars of
/// some points; none if no point is used. Where a known force was applied, a - F/m stands for a.
std::vector<Plot> phase_plots(const core::AnalysisResults& results, const PhaseGroup& group);

}  // namespace glidelab::report
