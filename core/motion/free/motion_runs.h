/// The direction of a motion at every point, where it turns and where it rests, from a first smoothing of the clip.
#pragma once

#include <cstddef>
#include <vector>

#include "core/motion/free/motion.h"

namespace glidelab::core {

struct PointRange {
  std::size_t from = 0;
  std::size_t to = 0;  ///< one past the last
  std::size_t size() const { return to - from; }
};

/// The longest ranges of equal value, in order; together they cover all points.
template <typename T>
std::vector<PointRange> ranges_of(const std::vector<T>& values) {
  std::vector<PointRange> ranges;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] != values[i - 1]) ranges.push_back({i, i});
    ranges.back().to = i + 1;
  }
  return ranges;
}

/// Sets the values of a range.
template <typename T>
void fill_range(std::vector<T>& values, const PointRange& range, const T& value) {
  for (std::size_t i = range.from; i < range.to; ++i) values[i] = value;
}

/// The sign of v, and the rest, of every point come from this.
struct Pilot {
  double bandwidth_s = 0.0;
  std::vector<double> x_m;       ///< as measured where it is not smoothed
  std::vector<double> v_m_s;     ///< of x
  std::vector<double> a_m_s2;    ///< of y: without the known force
  std::vector<double> sd_v_m_s;  ///< both infinite where the kernel holds too few points; v and a are zero there
  std::vector<double> sd_a_m_s2;
  double top_speed_m_s = 0.0;  ///< 95 % quantile of |v|
};

inline constexpr double kStillShare = 0.005;  ///< of the top speed

/// |v| below this is no motion: five standard deviations of v, or 0.5 % of the top speed.
double still_below(const Pilot& pilot, std::size_t point);

/// Takes the least bandwidth, from two time steps on, at which the standard deviation of a is at most 10 % of the
/// median |a| of the moving points; at most a twelfth of the time that they span. Needs four points.
Pilot first_smoothing(const Motion& motion);

struct MotionRuns {
  std::vector<int> direction;        ///< of every point: the sign of v, 0 at rest
  std::vector<double> turns_s;       ///< times at which v changes its sign
  std::vector<double> rest_edges_s;  ///< times at which a rest begins or ends
};

/// Direction: the sign of v where |v| is significant (still_below) and the run of equal signs covers at least twenty
/// standard deviations of a position; in less, the noise leaves an acceleration uncertain by a fifth and more.
///
/// Between two runs lies a rest, where x has next to no slope and curvature for three pilot bandwidths; it is grown
/// while x stays within three standard deviations of its median, so that what borders on it is truly moving. Otherwise
/// it is a reversal (or a slow passage), split where the smoothed x is extreme.
MotionRuns find_runs(const Motion& motion, const Pilot& pilot);

}  // namespace glidelab::core
