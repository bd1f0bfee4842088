/// A first smoothing of a whole clip, good enough to tell motion from rest, directions, and impacts.
#pragma once

#include <vector>

#include "core/motion/free/motion.h"

namespace glidelab::core {

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

}  // namespace glidelab::core
