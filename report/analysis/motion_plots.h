/// Plots of the motion: x(t), v(t) and a(t) of a clip, and a(v) with the lines a = a0 - (K/m) v fitted by an analysis,
/// at most one for each direction of motion.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/result/results.h"
#include "report/html/plot.h"

namespace glidelab::report {

/// The line for the sign of v (or of a direction, ±1); null if there is none, and at v = 0.
inline const core::LineFit* line_of(const std::vector<core::LineFit>& lines, double v_m_s) {
  const auto found =
      std::find_if(lines.begin(), lines.end(), [&](const core::LineFit& line) { return line.direction * v_m_s > 0.0; });
  return found == lines.end() ? nullptr : &*found;
}

/// a on the line, in m/s².
inline double line_at(const core::LineFit& line, double v_m_s) {
  return line.a0_m_s2.value - line.k_over_m_1_s.value * v_m_s;
}

/// x(t), v(t) and a(t) of one clip, as measured and smoothed, with omitted points in grey: three plots, or none if no
/// frame has a position.
std::vector<Plot> motion_plots(const core::ClipResult& clip);

/// Configurations that are shown in one diagram, in general all those of one stated inclination.
struct PhaseGroup {
  double incline_deg = 0.0;                 ///< of the first
  std::vector<std::size_t> configurations;  ///< indices into the results
};
/// One for each stated inclination, in order of first occurrence.
std::vector<PhaseGroup> phase_groups(const core::AnalysisResults& results);

/// "335 g", with the inclination ("335 g, 4°") if the diagram has several, and with the name of its group if another of
/// its configurations has the same mass and inclination.
std::string phase_label(const core::AnalysisResults& results, const PhaseGroup& group, std::size_t configuration);

/// Half of the 95 % interval of a line at v, in m/s²: t sqrt(var(a0) - 2 v cov(K/m, a0) + v² var(K/m)), with the t of
/// the line's own intervals; 0 for a line without errors.
double line_half95_m_s2(const core::LineFit& line, double v_m_s);

/// a(v) diagrams like the paper's figures 6 to 9: points of all masses on one stated inclination, their lines, and the
/// gap at v = 0. The diagram, its detail near v = 0, and the residuals of the lines, each with the lines' 95 % bands
/// and the bars of some points; none if no point is used. If a known force was applied, a is replaced by a - F/m.
std::vector<Plot> phase_plots(const core::AnalysisResults& results, const PhaseGroup& group);

/// The a(v) diagram of all configurations, whatever their inclination: the first plot of phase_plots(), with the
/// inclination in the labels if there are several, and without a legend if there are more configurations than colours.
/// Nothing if no point is used.
std::optional<Plot> phase_overview(const core::AnalysisResults& results);

}  // namespace glidelab::report
