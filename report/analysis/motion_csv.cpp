#include "report/analysis/motion_csv.h"

#include <optional>

#include "base/text/csv.h"
#include "report/analysis/fitted_lines.h"
#include "report/analysis/motion_row.h"
#include "report/text/output_names.h"

namespace glidelab::report {
namespace {

/// a on the clip's own line; nothing where there is none, and for a clip with a known force.
std::optional<double> own_line_at(const core::ClipResult& clip, double v_m_s) {
  const core::LineFit* const line = clip.forced ? nullptr : line_of(clip.segments, v_m_s);
  return line == nullptr ? std::nullopt : std::optional(line_at(*line, v_m_s));
}

}  // namespace

std::string motion_csv(const core::ClipResult& clip) {
  base::CsvWriter table(
      "t_s,measured_x_m,x_m,sd_x_m,residual_x_m,v_m_s,sd_v_m_s,a_m_s2,sd_a_m_s2,line_a_m_s2,residual_a_m_s2,reason");
  for (const core::MotionPoint& point : clip.motion) {
    MotionRow row(table, clip, point.t_s);
    const auto smoothed = [&](double value) { return point.smoothed ? std::optional(value) : std::nullopt; };
    row.put(point.t_s);
    row.put(point.measured_m);
    row.put(smoothed(point.x_m));
    row.put(smoothed(point.sd_x_m));
    row.put(point.measured_m ? smoothed(*point.measured_m - point.x_m) : std::nullopt);
    row.put(smoothed(point.v_m_s));
    row.put(smoothed(point.sd_v_m_s));
    row.put(smoothed(point.a_m_s2));
    row.put(smoothed(point.sd_a_m_s2));
    const std::optional<double> line = point.smoothed ? own_line_at(clip, point.v_m_s) : std::nullopt;
    row.put(line);
    row.put(line ? std::optional(point.a_m_s2 - *line) : std::nullopt);
    table.text(core::describe(point.left_out));
    table.end_row();
  }
  return table.str();
}

std::vector<std::string> motion_file_names(const core::AnalysisResults& results) {
  std::vector<std::string> names = phase_file_names(results);
  for (std::string& name : names) name.replace(0, std::string("phase").size(), "motion");
  return names;
}

}  // namespace glidelab::report
