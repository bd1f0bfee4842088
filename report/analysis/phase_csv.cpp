#include "report/analysis/phase_csv.h"

#include "base/text/csv.h"
#include "report/analysis/motion_row.h"

namespace glidelab::report {
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

}  // namespace glidelab::report
