#include "sim/force/force_terms.h"

#include <cmath>

namespace glidelab::sim {

double ViscousForce::force_n(double v_m_s, int, const Contact&) const {
  return -k_n_s_m_ * v_m_s;
}
double ViscousForce::slope_n_s_m(double, int, const Contact&) const {
  return -k_n_s_m_;
}

double CoulombForce::force_n(double, int direction, const Contact& contact) const {
  return -direction * mu_ * contact.normal_n;
}
double CoulombForce::slope_n_s_m(double, int, const Contact&) const {
  return 0.0;
}

// d v^2 rather than v |v|: the same on the side where it counts, and smooth beyond v = 0.
double QuadraticForce::force_n(double v_m_s, int direction, const Contact&) const {
  return -direction * c_n_s2_m2_ * v_m_s * v_m_s;
}
double QuadraticForce::slope_n_s_m(double v_m_s, int direction, const Contact&) const {
  return -2.0 * direction * c_n_s2_m2_ * v_m_s;
}

double PowerLawForce::force_n(double v_m_s, int, const Contact&) const {
  return -k_n_s_m_ * std::copysign(std::pow(std::abs(v_m_s), n_), v_m_s);
}
double PowerLawForce::slope_n_s_m(double v_m_s, int, const Contact&) const {
  return k_n_s_m_ == 0.0 ? 0.0 : -k_n_s_m_ * n_ * std::pow(std::abs(v_m_s), n_ - 1.0);
}

double StribeckForce::force_n(double v_m_s, int direction, const Contact& contact) const {
  const double u = v_m_s / v_s_m_s_;
  return -direction * mu_ * contact.normal_n * (1.0 + (s_ - 1.0) * std::exp(-u * u));
}
double StribeckForce::slope_n_s_m(double v_m_s, int direction, const Contact& contact) const {
  const double u = v_m_s / v_s_m_s_;
  return direction * mu_ * contact.normal_n * (s_ - 1.0) * std::exp(-u * u) * 2.0 * u / v_s_m_s_;
}

double EddyRolloffForce::force_n(double v_m_s, int, const Contact&) const {
  const double u = v_m_s / v_c_m_s_;
  return -k_n_s_m_ * v_m_s / (1.0 + u * u);
}
double EddyRolloffForce::slope_n_s_m(double v_m_s, int, const Contact&) const {
  const double u2 = v_m_s / v_c_m_s_ * (v_m_s / v_c_m_s_);
  return -k_n_s_m_ * (1.0 - u2) / ((1.0 + u2) * (1.0 + u2));
}

double ConstantForce::force_n(double, int, const Contact&) const {
  return force_n_;
}
double ConstantForce::slope_n_s_m(double, int, const Contact&) const {
  return 0.0;
}

}  // namespace glidelab::sim
