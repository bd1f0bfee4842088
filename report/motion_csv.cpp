#include "report/motion_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/csv.h"
#include "base/errors.h"
#include "report/file_names.h"

namespace glidelab::report {
namespace {

class Row {
 public:
  Row(base::CsvWriter& table, const core::ClipResult& clip, double t_s) : table_(table), clip_(clip), t_s_(t_s) {}
  void put(std::optional<double> value) {
    if (!value) {
      table_.empty();
    } else if (std::isfinite(*value)) {
      table_.number(*value);
    } else {
      throw base::NumericalError(
          fmt::format("clip \"{}\": the smoothed motion at t = {} s is not finite", clip_.name, t_s_));
    }
  }

 private:
  base::CsvWriter& table_;
  const core::ClipResult& clip_;
  double t_s_;
};

std::optional<double> line_at(const core::ClipResult& clip, double v_m_s) {
  if (clip.forced) return {};
  const auto line = std::find_if(clip.segments.begin(), clip.segments.end(),
                                 [&](const core::LineFit& of) { return of.direction * v_m_s > 0.0; });
  if (line == clip.segments.end()) return {};
  return line->a0_m_s2.value - line->k_over_m_1_s.value * v_m_s;
}

}  // namespace

std::string motion_csv(const core::ClipResult& clip) {
  base::CsvWriter table(
      "t_s,measured_x_m,x_m,sd_x_m,residual_x_m,v_m_s,sd_v_m_s,a_m_s2,sd_a_m_s2,line_a_m_s2,residual_a_m_s2,reason");
  for (const core::MotionPoint& point : clip.motion) {
    Row row(table, clip, point.t_s);
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
    const std::optional<double> line = point.smoothed ? line_at(clip, point.v_m_s) : std::nullopt;
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
