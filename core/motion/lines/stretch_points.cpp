#include "core/motion/lines/stretch_points.h"

#include <cmath>

namespace glidelab::core {
namespace {

/// Variance of a for a complete kernel over uniform points of the median step, in units of the noise's.
double complete_variance(double step_s, double bandwidth_s) {
  const auto half = static_cast<std::size_t>(std::ceil(kKernelReach * bandwidth_s / step_s)) + 1;
  std::vector<double> t(2 * half + 1);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<double>(i) * step_s;
  const auto row = LocalCubic(t, bandwidth_s).row_of_point(half);
  return row ? noise_variance(row->weights->a, std::vector<double>{1.0}) : 0.0;
}

}  // namespace

std::vector<StretchPoint> smooth_stretches(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                           double bandwidth_s, std::size_t stride, WantedPoints wanted) {
  std::vector<StretchPoint> points;
  const double allowed = kGapVariance * complete_variance(motion.step_s, bandwidth_s);
  const double margin = kKernelMargin * bandwidth_s * (1.0 - 1e-9);
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const FreeStretch& stretch = stretches[s];
    const std::span t = std::span(motion.t_s).subspan(stretch.first, stretch.count);
    const std::span x = std::span(motion.x_m).subspan(stretch.first, stretch.count);
    const std::span y = std::span(motion.y_m).subspan(stretch.first, stretch.count);
    const LocalCubic cubic(t, bandwidth_s);
    RowVariance variance({1.0});
    for (std::size_t j = 0; j < t.size(); j += stride) {
      const double since = t[j] - t.front(), until = t.back() - t[j];
      const bool in_margin = since < margin || until < margin;
      if (wanted == WantedPoints::inner && (in_margin || stretch.whole != LeftOut::used)) continue;
      StretchPoint point;
      point.point = stretch.first + j;
      point.stretch = s;
      point.direction = stretch.direction;
      point.row = cubic.row_of_point(j);
      if (point.row) {
        point.smoothed = true;
        point.x = weighted_sums(*point.row, x);
        point.y = motion.forced ? weighted_sums(*point.row, y) : point.x;
        point.row->first += stretch.first;
      }
      if (stretch.whole != LeftOut::used) {
        point.left_out = stretch.whole;
      } else if (in_margin) {
        point.left_out = since < until ? stretch.start : stretch.end;
      } else if (!point.row || variance.of_a(*point.row) > allowed) {
        point.left_out = LeftOut::kernel_gap;
      } else if (point.x.v_m_s * stretch.direction <= 0.0) {
        point.left_out = LeftOut::kernel_reversal;
      }
      points.push_back(std::move(point));
    }
  }
  return points;
}

std::vector<double> smoothing_bias(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<double>& law_m_s2, const std::vector<StretchPoint>& points) {
  std::vector<double> place(motion.t_s.size(), 0.0);  // double integral of the law, anew in each stretch
  for (const FreeStretch& stretch : stretches) {
    double v = 0.0, x = 0.0;
    for (std::size_t i = stretch.first + 1; i < stretch.first + stretch.count; ++i) {
      const double dt = motion.t_s[i] - motion.t_s[i - 1];
      x += v * dt + dt * dt * (2.0 * law_m_s2[i - 1] + law_m_s2[i]) / 6.0;
      v += 0.5 * dt * (law_m_s2[i - 1] + law_m_s2[i]);
      place[i] = x;
    }
  }
  std::vector<double> bias;
  for (const StretchPoint& point : points) {
    bias.push_back(point.row ? weighted_sums(*point.row, place).a_m_s2 - law_m_s2[point.point] : 0.0);
  }
  return bias;
}

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
