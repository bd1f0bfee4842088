#include "core/motion/lines/line_input.h"

namespace glidelab::core {

LineInput line_input(const Motion& motion, const std::vector<StretchPoint>& points, const std::vector<double>& bias,
                     int direction, double mass_kg, double mass_sd_kg) {
  LineInput input;
  input.track_points = motion.t_s.size();
  input.t_s = motion.t_s;
  input.forced = motion.forced;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const StretchPoint& point = points[j];
    if (point.direction != direction || point.left_out != LeftOut::used) continue;
    input.v_m_s.push_back(point.x.v_m_s);
    input.a_m_s2.push_back(point.y.a_m_s2);
    input.rows.push_back(*point.row);
    input.stretch.push_back(point.stretch);
    input.bias_a_m_s2.push_back(bias[j]);
    // a - F/m with F/m = x'' - y''; a heavier glider has less of it.
    const double of_force = mass_sd_kg > 0.0 ? (point.x.a_m_s2 - point.y.a_m_s2) * mass_sd_kg / mass_kg : 0.0;
    input.mass_part_m_s2.push_back(of_force);
  }
  return input;
}

std::vector<std::vector<MotionShift>> calibration_shifts(const Motion& motion, const LineInput& input,
                                                         const std::vector<std::vector<double>>& shared_m) {
  std::vector<std::vector<MotionShift>> shifts(shared_m.size());
  for (std::size_t mode = 0; mode < shared_m.size(); ++mode) {
    if (shared_m[mode].empty()) continue;
    std::vector<double> displacement;
    for (const std::size_t point : motion.point) displacement.push_back(shared_m[mode][point]);
    for (const KernelRow& row : input.rows) {
      const SmoothedPoint smoothed = weighted_sums(row, displacement);
      shifts[mode].push_back({smoothed.v_m_s, smoothed.a_m_s2});
    }
  }
  return shifts;
}

}  // namespace glidelab::core
