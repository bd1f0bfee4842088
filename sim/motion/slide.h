/// One stretch of sliding in one direction, as the system that the solver moves.
///
///     y = (x, w, E)     x' = v,     m v' = net force(v, direction),     E' = -(net force - m g sin(alpha)) v
///
/// v depends on nothing but itself, so |v| rises or falls all along, and whether it can reach 0 in finite time is known
/// from the force at v -> 0, F0:
///   * F0 against the direction: it does, and v = 0 is a root. The variable is w = v.
///   * F0 along the direction: it does not; no root. w = v.
///   * F0 = 0 (a level track without Coulomb friction): only where a force falls no faster than |v|^p, p < 1. Then
///     w = |v|^(1-p), which goes through 0 at a finite rate. Else |v| falls for ever, and w = ln |v| keeps it accurate
///     and its sign sure, so that rounding never makes a false root.
/// Where w = v, a term with an infinite slope at rest is a straight line between 0 and `least_speed_m_s`, a little
/// above the absolute tolerance of v: no solver resolves it there. It changes v by less than that speed (1e-12 m/s as
/// simulate() has it, which is 1e-11 m over 10 s).
#pragma once

#include <Eigen/Core>

#include "sim/force/force_law.h"
#include "sim/motion/cvodes_solver.h"

namespace glidelab::sim {

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

}  // namespace glidelab::sim
