#include "report/analysis/clip_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/text/csv.h"
#include "core/result/results.h"
#include "report/analysis/fitted_lines.h"
#include "report/text/result_names.h"

namespace glidelab::report {
namespace {

/// Of one frame of the clip, at t_s. Table and clip outlive it.
class MotionRow {
 public:
  MotionRow(base::CsvWriter& table, const core::ClipResult& clip, double t_s) : table_(table), clip_(clip), t_s_(t_s) {}
  /// NumericalError if the number is not finite; it names the clip and the time.
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

/// a on the clip's own line; nothing if there is none, and for a clip with a known force.
std::optional<double> own_line_at(const core::ClipResult& clip, double v_m_s) {
  const core::LineFit* const line = clip.forced ? nullptr : line_of(clip.segments, v_m_s);
  return line == nullptr ? std::nullopt : std::optional(line_at(*line, v_m_s));
}

}  // namespace

std::string phase_csv(const core::ClipResult& clip) {
  base::CsvWriter table("t_s,x_m,v_m_s,a_m_s2,used,sd_v_m_s,sd_a_m_s2,measured_x_m,reason");
  for (const core::MotionPoint& point : clip.motion) {
    if (!point.smoothed) continue;
    MotionRow row(table, clip, point.t_s);
    for (const double value : {point.t_s, point.x_m, point.v_m_s, point.a_m_s2}) row.put(value);
    row.put(point.left_out == core::LeftOut::used ? 1.0 : 0.0);
    for (const double value : {point.sd_v_m_s, point.sd_a_m_s2}) row.put(value);
    row.put(point.measured_m);
    table.text(core::describe(point.left_out));
    table.end_row();
  }
  return table.str();
}

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
