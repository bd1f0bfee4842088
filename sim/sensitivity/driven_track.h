/// Motion under viscous and Coulomb friction and a recorded drive, with derivatives in closed form.
///
///     dv/dt = d + p(t) - k v - s f,     s = sign(v),     p(t) linear between its samples
///
/// Over a piece on which p = p0 + b t, from (x0, v0), with a0 = d + p0 - s f, while v keeps its sign:
///
///     x = x0 + v0 phi + a0 psi + b chi,     v = v0 e + a0 phi + b psi,
///     e = exp(-k t),  phi = (1 - e)/k,  psi = (t - phi)/k,  chi = (t²/2 - psi)/k
///
/// v has at most one extremum on a piece, so its zeros are bracketed by the piece's ends and that extremum. At v = 0
/// the glider sticks if |d + p| <= f, until the drive exceeds f; otherwise it turns. The derivatives jump as described
/// at the top of sensitivity.h; those of v are 0 when it sets off (the net force is 0 then). All formulas pass smoothly
/// into k = 0.
#pragma once

#include <span>
#include <vector>

#include "sim/sensitivity/sensitivity.h"

namespace glidelab::sim {

/// p at rising times, linear between them; before the first and after the last sample it is constant.
struct RecordedDrive {
  std::vector<double> t_s;
  std::vector<double> p_m_s2;
};

/// As track_motion_sensitive(), with which it agrees for p = 0: from (x0, v0) at t = 0, derivatives by k, d, f, x0, v0,
/// in this order, at each of `times_s` (rising, not negative). NumericalError if a number is not finite.
std::vector<SensitiveState> driven_track_sensitive(double k_1_s, double drive_m_s2, double friction_m_s2, double x0_m,
                                                   double v0_m_s, std::span<const double> times_s,
                                                   const RecordedDrive& recorded);

}  // namespace glidelab::sim
