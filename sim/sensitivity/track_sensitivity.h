/// Motion under viscous and Coulomb friction with its derivatives in closed form: what sim/sensitivity/sensitivity.h
/// integrates, for this law alone.
///
/// dv/dt = d - k v - s f, s = sign(v). From (x0, v0) while v keeps its sign, with a0 = d - s f:
///
///     x = x0 + v0 phi + a0 psi,   v = v0 e + a0 phi,   e = exp(-k t), phi = (1 - e)/k, psi = (t - phi)/k,
///
/// and the derivatives by k, d, f, x0, v0 term by term. At v = 0 (closed_forms.h: linear_stop_time_s) it sticks where
/// |d| <= f, else turns; the derivatives jump as sensitivity.h says, and go on by the same formulas from (x_T, 0). All
/// formulas go over into k = 0.
#pragma once

#include <span>
#include <vector>

#include "sim/sensitivity/sensitivity.h"

namespace glidelab::sim {

/// By k, d, f, x0, v0, in this order, at each of `times_s` (rising, not negative). From v0 = 0 the
/// glider sticks or moves with the drive. NumericalError where a number is not finite.
std::vector<SensitiveState> track_motion_sensitive(double k_1_s, double drive_m_s2, double friction_m_s2, double x0_m,
                                                   double v0_m_s, std::span<const double> times_s);

}  // namespace glidelab::sim
