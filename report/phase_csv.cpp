#include "report/phase_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "base/csv.h"
#include "base/errors.h"

namespace glidelab::report {
namespace {

double finite(double value, const core::ClipResult& clip, double t_s) {
  if (std::isfinite(value)) return value;
  throw base::NumericalError(fmt::format("clip \"{}\": the smoothed motion at t = {} s is not finite", clip.name, t_s));
}

}  // namespace

std::string phase_csv(const core::ClipResult& clip) {
  base::CsvWriter table("t_s,x_m,v_m_s,a_m_s2,used,sd_v_m_s,sd_a_m_s2,measured_x_m,reason");
  for (const core::MotionPoint& point : clip.motion) {
    if (!point.smoothed) continue;
    for (const double value : {point.t_s, point.x_m, point.v_m_s, point.a_m_s2}) {
      table.number(finite(value, clip, point.t_s));
    }
    table.number(point.left_out == core::LeftOut::used ? 1 : 0);
    for (const double value : {point.sd_v_m_s, point.sd_a_m_s2}) table.number(finite(value, clip, point.t_s));
    if (point.measured_m) {
      table.number(*point.measured_m);
    } else {
      table.empty();
    }
    table.text(core::describe(point.left_out));
    table.end_row();
  }
  return table.str();
}

}  // namespace glidelab::report
