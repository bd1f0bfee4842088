/// The force laws that a scenario can name, one class each.
///
/// Units: newtons along x, speeds in m/s, N = m g cos(alpha) the normal force, d = +1 or -1 the direction of sliding.
/// Parameters are what the class says and are not negative; who reads them from a file checks them there.
#pragma once

#include <string>

#include "sim/force/force_law.h"

namespace glidelab::sim {

/// -K v: magnetic damping at low speed (equation 1).
class ViscousForce final : public ForceTerm {
 public:
  explicit ViscousForce(double k_n_s_m) : k_n_s_m_(k_n_s_m) {}
  double k_n_s_m() const { return k_n_s_m_; }
  double force_n(double v_m_s, int direction, const Contact& contact) const override;
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override;
  std::string law() const override { return "viscous"; }

 private:
  double k_n_s_m_;
};

/// -d mu N while sliding, up to mu_static N at rest (equation 5); mu_static >= mu.
class CoulombForce final : public ForceTerm {
 public:
  CoulombForce(double mu, double mu_static) : mu_(mu), mu_static_(mu_static) {}
  explicit CoulombForce(double mu) : CoulombForce(mu, mu) {}
  double mu() const { return mu_; }
  double mu_static() const { return mu_static_; }
  double force_n(double v_m_s, int direction, const Contact& contact) const override;
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override;
  double holding_n(const Contact& contact) const override { return mu_static_ * contact.normal_n; }
  std::string law() const override { return "coulomb"; }

 private:
  double mu_, mu_static_;
};

/// -c v |v|: drag of the air at high Reynolds number.
class QuadraticForce final : public ForceTerm {
 public:
  explicit QuadraticForce(double c_n_s2_m2) : c_n_s2_m2_(c_n_s2_m2) {}
  double force_n(double v_m_s, int direction, const Contact& contact) const override;
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override;
  double exponent_at_rest() const override { return 2.0; }
  std::string law() const override { return "quadratic"; }

 private:
  double c_n_s2_m2_;
};

/// -K v |v / (1 m/s)|^(n-1), n > 0. For n < 1 the slope at v = 0 is minus infinity, and the term alone stops a glider
/// in finite time.
class PowerLawForce final : public ForceTerm {
 public:
  PowerLawForce(double k_n_s_m, double n) : k_n_s_m_(k_n_s_m), n_(n) {}
  double force_n(double v_m_s, int direction, const Contact& contact) const override;
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override;
  double exponent_at_rest() const override { return k_n_s_m_ == 0.0 ? 1.0 : n_; }
  std::string law() const override { return "power_law"; }

 private:
  double k_n_s_m_, n_;
};

/// -d mu N (1 + (s - 1) exp(-(v / v_s)^2)), s >= 1: friction that falls from s mu at rest to mu above v_s. Holds s mu
/// N.
class StribeckForce final : public ForceTerm {
 public:
  StribeckForce(double mu, double s, double v_s_m_s) : mu_(mu), s_(s), v_s_m_s_(v_s_m_s) {}
  double force_n(double v_m_s, int direction, const Contact& contact) const override;
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override;
  double holding_n(const Contact& contact) const override { return s_ * mu_ * contact.normal_n; }
  std::string law() const override { return "stribeck"; }

 private:
  double mu_, s_, v_s_m_s_;
};

/// -K v / (1 + (v / v_c)^2): eddy-current brake, which peaks at v_c and falls above it.
class EddyRolloffForce final : public ForceTerm {
 public:
  EddyRolloffForce(double k_n_s_m, double v_c_m_s) : k_n_s_m_(k_n_s_m), v_c_m_s_(v_c_m_s) {}
  double force_n(double v_m_s, int direction, const Contact& contact) const override;
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override;
  std::string law() const override { return "eddy_rolloff"; }

 private:
  double k_n_s_m_, v_c_m_s_;
};

/// The same force at every speed and at rest: a hanging weight, wind. Positive downhill.
class ConstantForce final : public ForceTerm {
 public:
  explicit ConstantForce(double force_n) : force_n_(force_n) {}
  double force_n(double v_m_s, int direction, const Contact& contact) const override;
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override;
  std::string law() const override { return "constant"; }

 private:
  double force_n_;
};

}  // namespace glidelab::sim
