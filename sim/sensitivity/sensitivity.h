/// A motion, and how it changes with every parameter of its law and with its start.
///
/// With p the parameters, then x0, then v0, and S = d(x, v)/dp:
///
///     Sx' = Sv,     Sv' = (da/dx) Sx + (da/dv) Sv + da/dp                                    (while it slides)
///
/// moved together with (x, v) by Adams' formulas. Where v comes to 0 at the time T, T itself depends on p,
/// dT/dp = -Sv / a(T-), so that S jumps (saltation; Aizerman and Gantmacher 1958):
///
///     Sx stays,     Sv(T+) = Sv(T-) a(T+) / a(T-)      slides back
///     Sx stays,     Sv(T+) = 0, and both stay so      sticks
///
/// x has no jump in its derivative for v = 0 on both sides.
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

#include "sim/motion/simulate.h"
#include "sim/sensitivity/motion_law.h"

namespace glidelab::sim {

struct SensitiveState {
  double t_s = 0.0;
  double x_m = 0.0;
  double v_m_s = 0.0;
  Mode mode = Mode::stick;
  /// Of x (first row) and v, by the law's parameters, x0 and v0.
  Eigen::Matrix<double, 2, Eigen::Dynamic> by_parameter;
};

/// From (x0, v0) at t = 0, at each of `times_s` (rising, not negative). A law with more than (kMostComponents - 2) / 2
/// - 2 parameters is a std::logic_error; NumericalError where CVODES fails. A glider that sticks stays: the law does
/// not depend on time.
std::vector<SensitiveState> simulate_sensitive(const MotionLaw& law, double x0_m, double v0_m_s,
                                               std::span<const double> times_s,
                                               const SolverOptions& options = {1e-10, 1e-12});

}  // namespace glidelab::sim
