#include "sim/motion/slide.h"

#include <algorithm>
#include <cmath>

namespace glidelab::sim {

namespace {

// Where F0 = 0, the ratio of the force to |v|^p is taken no nearer to rest than this, so that it does not become 0 / 0.
constexpr double kSpeedOfRatio = 1e-150;  // m/s

}  // namespace

Slide::Slide(const Body& body, int direction, double least_speed_m_s)
    : body_(body),
      direction_(direction),
      least_speed_m_s_(least_speed_m_s),
      contact_(contact_of(body)),
      weight_n_(weight_along_track_n(body)) {
  for (const auto& term : body.forces) exponent_ = std::min(exponent_, term->exponent_at_rest());
  const double along = direction * net_force_n(body, 0.0, direction);
  if (along != 0.0) {
    stops_ = along < 0.0;
    return;
  }
  stops_ = exponent_ < 1.0;
  variable_ = stops_ ? Variable::power : Variable::logarithm;
}

double Slide::variable(double v_m_s) const {
  if (variable_ == Variable::speed) return v_m_s;
  const double speed = direction_ * v_m_s;
  return variable_ == Variable::power ? std::pow(speed, 1.0 - exponent_) : std::log(speed);
}

double Slide::speed_m_s(double variable) const {
  switch (variable_) {
    case Variable::power:
      return variable > 0.0 ? direction_ * std::pow(variable, 1.0 / (1.0 - exponent_)) : 0.0;
    case Variable::logarithm:
      return direction_ * std::exp(variable);
    case Variable::speed:
      break;
  }
  return variable;
}

Slide::Force Slide::force_at(double v_m_s) const {
  Force sum{0.0, 0.0};
  for (const auto& term : body_.forces) {
    if (variable_ == Variable::speed && std::abs(v_m_s) < least_speed_m_s_ && term->exponent_at_rest() < 1.0) {
      const double at_rest = term->force_n(0.0, direction_, contact_);
      const double at_least = term->force_n(direction_ * least_speed_m_s_, direction_, contact_);
      const double slope = (at_least - at_rest) / (direction_ * least_speed_m_s_);
      sum.n += at_rest + slope * v_m_s;
      sum.slope_n_s_m += slope;
    } else {
      sum.n += term->force_n(v_m_s, direction_, contact_);
      sum.slope_n_s_m += term->slope_n_s_m(v_m_s, direction_, contact_);
    }
  }
  return sum;
}

double Slide::acceleration_m_s2(double v_m_s) const {
  return (weight_n_ + force_at(v_m_s).n) / body_.mass_kg;
}

Eigen::Vector3d Slide::rate(const Eigen::Vector3d& y) const {
  const double v = speed_m_s(y[1]);
  const double dissipated = -force_at(v).n * v;
  if (variable_ == Variable::speed) return {v, acceleration_m_s2(v), dissipated};
  const double speed = std::max(std::abs(v), kSpeedOfRatio);
  const double a = direction_ * acceleration_m_s2(direction_ * speed);
  if (variable_ == Variable::logarithm) return {v, a / speed, dissipated};
  return {v, (1.0 - exponent_) * a / std::pow(speed, exponent_), dissipated};
}

Eigen::Matrix3d Slide::jacobian(const Eigen::Vector3d& y) const {
  const double v = speed_m_s(y[1]);
  // Not nearer to rest than where rate() takes the ratio; there all but the ratio is 0.
  const double u = variable_ == Variable::speed ? v : direction_ * std::max(std::abs(v), kSpeedOfRatio);
  const Force force = force_at(u);
  double rate_by_variable = force.slope_n_s_m / body_.mass_kg;
  double speed_by_variable = 1.0;
  if (variable_ != Variable::speed) {
    // w' = |v|' / |v|^p up to a factor, so dw'/dw = (F'(v) - p F / v) / m, with p = 1 for the logarithm.
    rate_by_variable -= exponent_ * (weight_n_ + force.n) / u / body_.mass_kg;
    speed_by_variable =
        variable_ == Variable::logarithm ? v : direction_ * std::pow(std::abs(v), exponent_) / (1.0 - exponent_);
  }
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  jacobian(0, 1) = speed_by_variable;
  jacobian(1, 1) = rate_by_variable;
  jacobian(2, 1) = -(force.n + v * force.slope_n_s_m) * speed_by_variable;
  return jacobian;
}

OdeSystem Slide::system(double relative_tolerance, double absolute_tolerance) const {
  OdeSystem system;
  system.rate = [*this](const Eigen::Vector3d& y) { return rate(y); };
  system.jacobian = [*this](const Eigen::Vector3d& y) { return jacobian(y); };
  if (stops_) system.event = [](const Eigen::Vector3d& y) { return y[1]; };
  system.event_crossing = variable_ == Variable::speed ? -direction_ : -1;
  system.relative_tolerance = relative_tolerance;
  system.absolute_tolerance = absolute_tolerance * Eigen::Vector3d(1.0, 1.0, body_.mass_kg);
  return system;
}

}  // namespace glidelab::sim
