/// The events of a motion: its direction at every point, and the exact times at which it turns or rests.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
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

/// A first smoothing of the clip. It gives the sign of v, or rest, at every point.
struct Pilot {
  double bandwidth_s = 0.0;
  std::vector<double> x_m;       ///< as measured if not smoothed
  std::vector<double> v_m_s;     ///< of x
  std::vector<double> a_m_s2;    ///< second derivative of y: without the known force
  std::vector<double> sd_v_m_s;  ///< both infinite if the kernel holds too few points; v and a are then zero
  std::vector<double> sd_a_m_s2;
  double top_speed_m_s = 0.0;  ///< 95 % quantile of |v|
};

inline constexpr double kStillShare = 0.005;  ///< of the top speed

/// |v| below this counts as no motion: five standard deviations of v, or 0.5 % of the top speed.
double still_below(const Pilot& pilot, std::size_t point);

/// Takes the smallest bandwidth, from two time steps on, at which the standard deviation of a is at most 10 % of the
/// median |a| of the moving points; at most a twelfth of the time that they span. Needs four points.
Pilot first_smoothing(const Motion& motion);

/// The direction of a motion at every point, and the times at which it turns and rests.
struct MotionRuns {
  std::vector<int> direction;        ///< of every point: the sign of v, 0 at rest
  std::vector<double> turns_s;       ///< times at which v changes sign
  std::vector<double> rest_edges_s;  ///< times at which a rest begins or ends
};

/// Direction: the sign of v where |v| is significant (still_below) and the run of equal signs covers at least twenty
/// standard deviations of a position. Over a shorter distance, noise leaves the acceleration uncertain by a fifth or
/// more.
///
/// Where v is significant nowhere, as in a slow motion with long gaps, the clip rests if its ends are less than that
/// distance apart.
///
/// Between two runs lies a rest if x has almost no slope and curvature for three pilot bandwidths; it is extended while
/// x stays within three standard deviations of its median, so that the adjacent points are truly moving. Otherwise it
/// is a reversal (or a slow passage), split where the smoothed x is extreme.
MotionRuns find_runs(const Motion& motion, const Pilot& pilot);

enum class EventKind { turns, stops };

struct EventTime {
  double t_s = 0.0;
  double sd_s = 0.0;
  double x_m = 0.0;
  double before_m_s2 = 0.0;  ///< a just before
  double after_m_s2 = 0.0;   ///< a just after; 0 at a stop
};

/// When a motion turns or stops, estimated from the positions around it.
///
/// Coulomb friction makes a jump where v = 0: at a reversal from a_minus to a_plus, at a stop to zero. x and v are
/// continuous, so about the event t*, with u = t - t*,
///
///     u < 0:  x = x* + a_minus u^2/2 + j_minus u^3/6
///     u > 0:  x = x* + a_plus u^2/2 + j_plus u^3/6       (at a stop both are 0)
///
/// is fitted by least squares to the points within a window on both sides. It is linear except for t*, which is found
/// by the Gauss-Newton method from the given start. The fit also gives a on both sides: one-sided, with v(t*) = 0 built
/// in. The standard deviation is that of the linearised fit; correlated noise enters by its sum over all lags. Assumes
/// that j varies little within the window.
///
/// Empty if fewer than five points lie on a side, if the fit does not settle within the window, or if a does not have
/// the sign that the kind of event requires.
std::optional<EventTime> estimate_event(std::span<const double> t_s, std::span<const double> x_m, EventKind kind,
                                        double near_s, double window_s, const std::vector<double>& autocovariance);

}  // namespace glidelab::core
