/// How a motion changes with the parameters of its law and with its initial state: by the solver, and in closed form on
/// a track.
///
/// With p the parameters, then x0, then v0, and S = d(x, v)/dp:
///
///     Sx' = Sv,     Sv' = (da/dx) Sx + (da/dv) Sv + da/dp                                    (while it slides)
///
/// If v comes to 0 at time T, T itself depends on p, dT/dp = -Sv / a(T-), so that S jumps (saltation; Aizerman and
/// Gantmacher 1958):
///
///     Sx stays,     Sv(T+) = Sv(T-) a(T+) / a(T-)      slides back
///     Sx stays,     Sv(T+) = 0, and both stay so      sticks
///
/// The derivative of x does not jump, because v = 0 on both sides.
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

#include "sim/force/force_law.h"
#include "sim/motion/cvodes_solver.h"
#include "sim/motion/simulate.h"

namespace glidelab::sim {

/// The acceleration in m/s² and its derivatives, at one state of sliding.
struct LawValue {
  double a_m_s2 = 0.0;
  double by_x_1_s2 = 0.0;
  double by_v_1_s = 0.0;
  OdeVector by_parameter;  ///< one for each parameter of the law
};

/// A law of motion with parameters, as a fit needs it: the acceleration and its derivatives.
class MotionLaw {
 public:
  virtual ~MotionLaw() = default;
  virtual int parameter_count() const = 0;
  /// While the glider slides in `direction` (+1 or -1); v may be 0.
  virtual LawValue sliding(double x_m, double v_m_s, int direction) const = 0;
  /// What drives the glider at rest, and how much static friction holds.
  virtual double load_m_s2(double x_m) const = 0;
  virtual double holding_m_s2(double x_m) const = 0;
};

/// Viscous and Coulomb friction per mass, a = drive - k v - direction friction, with drive = g sin(alpha) and
/// friction = mu g cos(alpha). Parameters in the order k, drive, friction; at rest the friction holds as much as it
/// opposes while sliding.
class TrackLaw final : public MotionLaw {
 public:
  TrackLaw(double k_1_s, double drive_m_s2, double friction_m_s2)
      : k_1_s_(k_1_s), drive_m_s2_(drive_m_s2), friction_m_s2_(friction_m_s2) {}
  int parameter_count() const override { return 3; }
  LawValue sliding(double x_m, double v_m_s, int direction) const override;
  double load_m_s2(double) const override { return drive_m_s2_; }
  double holding_m_s2(double) const override { return friction_m_s2_; }

 private:
  double k_1_s_, drive_m_s2_, friction_m_s2_;
};

/// A body under any sum of force laws. Parameters: those of its terms, term by term, each in the order of its law.
class BodyLaw final : public MotionLaw {
 public:
  explicit BodyLaw(Body body);
  int parameter_count() const override { return parameters_; }
  LawValue sliding(double x_m, double v_m_s, int direction) const override;
  double load_m_s2(double) const override { return load_at_rest_n(body_) / body_.mass_kg; }
  double holding_m_s2(double) const override { return sim::holding_n(body_) / body_.mass_kg; }

 private:
  Body body_;
  Contact contact_;
  int parameters_ = 0;
};

struct SensitiveState {
  double t_s = 0.0;
  double x_m = 0.0;
  double v_m_s = 0.0;
  Mode mode = Mode::stick;
  /// Derivatives of x (first row) and v by the law's parameters, x0 and v0.
  Eigen::Matrix<double, 2, Eigen::Dynamic> by_parameter;
};

/// A motion, and how it changes with every parameter of its law and with its initial state: S is integrated together
/// with (x, v) by Adams formulas. From (x0, v0) at t = 0, at each of `times_s` (rising, not negative). A law with more
/// than (kMostComponents - 2) / 2 - 2 parameters is a std::logic_error; NumericalError if CVODES fails. A glider
/// that sticks stays: the law does not depend on time.
std::vector<SensitiveState> simulate_sensitive(const MotionLaw& law, double x0_m, double v0_m_s,
                                               std::span<const double> times_s,
                                               const SolverOptions& options = {1e-10, 1e-12});

/// Motion under viscous and Coulomb friction with its derivatives in closed form: what simulate_sensitive() integrates,
/// for this law alone.
///
/// dv/dt = d - k v - s f, s = sign(v). From (x0, v0) while v keeps its sign, with a0 = d - s f:
///
///     x = x0 + v0 phi + a0 psi,   v = v0 e + a0 phi,   e = exp(-k t), phi = (1 - e)/k, psi = (t - phi)/k,
///
/// and the derivatives by k, d, f, x0, v0 term by term. At v = 0 (closed_forms.h: linear_stop_time_s) it sticks where
/// |d| <= f, else turns; the derivatives jump as the head of this file says, and go on by the same formulas from (x_T,
/// 0). All formulas pass smoothly into k = 0.
///
/// By k, d, f, x0, v0, in this order, at each of `times_s` (rising, not negative). From v0 = 0 the glider sticks or
/// moves with the drive. NumericalError if a number is not finite.
std::vector<SensitiveState> track_motion_sensitive(double k_1_s, double drive_m_s2, double friction_m_s2, double x0_m,
                                                   double v0_m_s, std::span<const double> times_s);

}  // namespace glidelab::sim
