/// The motion of a body as a hybrid system: slide up, slide down, stick; the solver integrates each slide as one
/// stretch.
///
///     m dv/dt = m g sin(alpha) + sum of forces(v, sign v)     while sliding;     v = 0     while sticking.
///
/// v = 0 is a root of the sliding modes. At a root the glider sticks where |m g sin(alpha) + smooth forces at rest|
/// does not exceed what static friction holds; otherwise it slides on with the sign of the net force; the solver is
/// reinitialised there. sign(v) is never smoothed. The forces depend on v only, so a glider that has come to rest stays
/// at rest, and one that has reversed never reverses again. Method: CVODES, BDF with Newton and the analytic slope
/// (Slide::jacobian), tolerances in SolverOptions.
#pragma once

#include <Eigen/Core>

#include <span>
#include <string_view>
#include <vector>

#include "sim/force/force_law.h"
#include "sim/motion/cvodes_solver.h"

namespace glidelab::sim {

/// One stretch of sliding in one direction, as the system that the solver moves.
///
///     y = (x, w, E)     x' = v,     m v' = net force(v, direction),     E' = -(net force - m g sin(alpha)) v
///
/// v depends only on itself, so |v| rises or falls throughout, and whether it can reach 0 in finite time is known from
/// the force at v -> 0, F0:
///   * F0 against the direction: |v| reaches 0, and v = 0 is a root. The variable is w = v.
///   * F0 along the direction: it does not, and there is no root. w = v.
///   * F0 = 0 (a level track without Coulomb friction): it does only where a force falls no faster than |v|^p, p < 1.
///     Then w = |v|^(1-p), which goes through 0 at a finite rate. Otherwise |v| falls for ever, and w = ln |v| keeps it
///     accurate and its sign certain, so that rounding never makes a false root.
///
/// Where w = v, a term with an infinite slope at rest is a straight line between 0 and `least_speed_m_s`, a little
/// above the absolute tolerance of v: no solver resolves it there. This changes v by less than that speed (1e-12 m/s in
/// simulate(), which is 1e-11 m over 10 s).
class Slide {
 public:
  /// `direction` is +1 or -1.
  Slide(const Body& body, int direction, double least_speed_m_s);

  /// Whether v comes to 0 in finite time.
  bool stops() const { return stops_; }
  double variable(double v_m_s) const;
  double speed_m_s(double variable) const;
  double acceleration_m_s2(double v_m_s) const;

  Eigen::Vector3d rate(const Eigen::Vector3d& y) const;
  Eigen::Matrix3d jacobian(const Eigen::Vector3d& y) const;
  /// Tolerances of x, of w, and of E scaled by the mass.
  OdeSystem system(double relative_tolerance, double absolute_tolerance) const;

 private:
  enum class Variable { speed, power, logarithm };
  struct Force {
    double n;            ///< of all terms, without gravity
    double slope_n_s_m;  ///< d n / dv
  };
  Force force_at(double v_m_s) const;

  Body body_;
  int direction_;
  double least_speed_m_s_;
  Contact contact_;
  double weight_n_;
  Variable variable_ = Variable::speed;
  double exponent_ = 1.0;  ///< least of the terms' exponents at rest and 1
  bool stops_ = false;
};

enum class Mode { slide_up = -1, stick = 0, slide_down = 1 };

/// "slide_up", "stick", "slide_down".
std::string_view name_of(Mode mode);

/// What a body at v = 0 does: it sticks if |load at rest| <= what static friction holds (equality within rounding);
/// otherwise it slides with the sign of the load.
Mode mode_at_rest(const Body& body);

struct State {
  double t_s = 0.0;
  double x_m = 0.0;
  double v_m_s = 0.0;
  double a_m_s2 = 0.0;
  Mode mode = Mode::stick;
};

/// A change of mode.
struct ModeChange {
  double t_s = 0.0;
  double x_m = 0.0;
  Mode from = Mode::stick;
  Mode to = Mode::stick;
};

struct Trajectory {
  std::vector<State> states;  ///< one for each requested time
  std::vector<ModeChange> changes;
  double dissipated_j = 0.0;  ///< work done against all forces but gravity, up to the last requested time
  long solver_steps = 0;
};

struct SolverOptions {
  double relative_tolerance = 1e-13;
  double absolute_tolerance = 1e-14;  ///< of x in m and v in m/s
};

/// With the standard tolerances, and with speeds and distances typical of a track, positions are within 1e-9 m over 10
/// s. The time of a reversal is within 1e-9 s if the glider comes to v = 0 with 1 mm/s² or more (an error dv makes one
/// of dv / a).
///
/// Moves the body from (x0, v0) at t = 0 and returns its state at each of `times_s` (rising, not negative). At a
/// requested time that is the instant of a reversal, the mode is the one after it. InputError if a number is not finite
/// or the times do not rise; NumericalError with time, step and tolerance if CVODES fails. Exceptions thrown by a term
/// pass through.
Trajectory simulate(const Body& body, double x0_m, double v0_m_s, std::span<const double> times_s,
                    const SolverOptions& options = {});

}  // namespace glidelab::sim
