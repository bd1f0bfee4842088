#include "sim/sensitivity/motion_law.h"

#include <vector>

namespace glidelab::sim {

LawValue TrackLaw::sliding(double, double v_m_s, int direction) const {
  LawValue value;
  value.a_m_s2 = drive_m_s2_ - k_1_s_ * v_m_s - direction * friction_m_s2_;
  value.by_v_1_s = -k_1_s_;
  value.by_parameter.resize(3);
  value.by_parameter << -v_m_s, 1.0, -direction;
  return value;
}

BodyLaw::BodyLaw(Body body) : body_(std::move(body)), contact_(contact_of(body_)) {
  for (const auto& term : body_.forces) parameters_ += static_cast<int>(term->by_parameter(1.0, +1, contact_).size());
}

LawValue BodyLaw::sliding(double, double v_m_s, int direction) const {
  LawValue value;
  value.a_m_s2 = net_force_n(body_, v_m_s, direction) / body_.mass_kg;
  value.by_parameter.resize(parameters_);
  int next = 0;
  for (const auto& term : body_.forces) {
    value.by_v_1_s += term->slope_n_s_m(v_m_s, direction, contact_) / body_.mass_kg;
    for (const double by : term->by_parameter(v_m_s, direction, contact_)) {
      value.by_parameter[next++] = by / body_.mass_kg;
    }
  }
  return value;
}

}  // namespace glidelab::sim
