/// When a motion turns or stops, estimated from the positions around it.
///
/// Coulomb friction makes a jump where v = 0: at a reversal from a_minus to a_plus, at a stop to zero. x and v are
/// continuous, so about the event t*, with u = t - t*,
///
///     u < 0:  x = x* + a_minus u^2/2 + j_minus u^3/6
///     u > 0:  x = x* + a_plus u^2/2 + j_plus u^3/6       (at a stop both are 0)
///
/// is fitted by least squares to the points within a window on both sides. It is linear but for t*, which is found by
/// Gauss and Newton's method from the given start. Both sides' a come out as well: one-sided, with v(t*) = 0 built in.
/// The standard deviation is that of the linearised fit; noise that is correlated counts by its sum over all lags.
/// Assumes that j varies little within the window.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

enum class EventKind { turns, stops };

struct EventTime {
  double t_s = 0.0;
  double sd_s = 0.0;
  double x_m = 0.0;
  double before_m_s2 = 0.0;  ///< a just before
  double after_m_s2 = 0.0;   ///< a just after; 0 at a stop
};

/// Nothing where fewer than five points lie on a side, where the fit does not settle within the window, or where a does
/// not have the sign that the kind of event needs.
std::optional<EventTime> estimate_event(std::span<const double> t_s, std::span<const double> x_m, EventKind kind,
                                        double near_s, double window_s, const std::vector<double>& autocovariance);

}  // namespace glidelab::core
