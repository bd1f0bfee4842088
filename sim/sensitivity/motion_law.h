/// A law of motion with parameters, as a fit needs it: the acceleration and its derivatives.
#pragma once

#include "sim/force/force_law.h"
#include "sim/motion/cvodes_solver.h"

namespace glidelab::sim {

/// m/s² and its derivatives at one state of sliding.
struct LawValue {
  double a_m_s2 = 0.0;
  double by_x_1_s2 = 0.0;
  double by_v_1_s = 0.0;
  OdeVector by_parameter;  ///< one for each parameter of the law
};

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

}  // namespace glidelab::sim
