#include "sim/slide.h"

#include <algorithm>
#include <cmath>

namespace glidelab::sim {

namespace {

// Where F0 = 0, the ratio of the force to |v|^p is taken no nearer to rest than this, so that it does not become 0 / 0.
constexpr double kLeastSpeed = 1e-150;  // m/s
// Where the slope at rest is infinite, it is taken no nearer to rest than this. It only steers Newton's method, not the
// solution.
constexpr double kNewtonSpeed = 1e-9;  // m/s

}  // namespace

Slide::Slide(const Body& body, int direction)
    : body_(&body), direction_(direction), weight_n_(weight_along_track_n(body)) {
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

double Slide::acceleration_m_s2(double v_m_s) const {
  return net_force_n(*body_, v_m_s, direction_) / body_->mass_kg;
}

Eigen::Vector3d Slide::rate(const Eigen::Vector3d& y) const {
  const double v = speed_m_s(y[1]);
  const double dissipated = -(net_force_n(*body_, v, direction_) - weight_n_) * v;
  if (variable_ == Variable::speed) return {v, acceleration_m_s2(v), dissipated};
  const double speed = std::max(std::abs(v), kLeastSpeed);
  const double a = direction_ * acceleration_m_s2(direction_ * speed);
  if (variable_ == Variable::logarithm) return {v, a / speed, dissipated};
  return {v, (1.0 - exponent_) * a / std::pow(speed, exponent_), dissipated};
}

Eigen::Matrix3d Slide::jacobian(const Eigen::Vector3d& y) const {
  const double v = speed_m_s(y[1]);
  const bool steep = exponent_ < 1.0 && std::abs(v) < kNewtonSpeed;
  double slope = net_slope_n_s_m(*body_, steep ? direction_ * kNewtonSpeed : v, direction_);
  double rate_by_variable = slope / body_->mass_kg;
  double speed_by_variable = 1.0;
  if (variable_ != Variable::speed) {
    // w' = |v|' / |v|^p up to a factor, so dw'/dw = (F'(v) - p F / v) / m.
    const double u = direction_ * std::max(std::abs(v), kLeastSpeed);
    rate_by_variable =
        (net_slope_n_s_m(*body_, u, direction_) - exponent_ * net_force_n(*body_, u, direction_) / u) / body_->mass_kg;
    speed_by_variable =
        variable_ == Variable::logarithm ? v : direction_ * std::pow(std::abs(v), exponent_) / (1.0 - exponent_);
    slope = net_slope_n_s_m(*body_, u, direction_);
  }
  const double power_by_speed = -(net_force_n(*body_, v, direction_) - weight_n_ + v * slope);
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  jacobian(0, 1) = speed_by_variable;
  jacobian(1, 1) = rate_by_variable;
  jacobian(2, 1) = power_by_speed * speed_by_variable;
  return jacobian;
}

OdeSystem Slide::system(double relative_tolerance, double absolute_tolerance) const {
  OdeSystem system;
  system.rate = [*this](const Eigen::Vector3d& y) { return rate(y); };
  system.jacobian = [*this](const Eigen::Vector3d& y) { return jacobian(y); };
  if (stops_) system.event = [](const Eigen::Vector3d& y) { return y[1]; };
  system.event_crossing = variable_ == Variable::speed ? -direction_ : -1;
  system.relative_tolerance = relative_tolerance;
  system.absolute_tolerance = absolute_tolerance * Eigen::Vector3d(1.0, 1.0, body_->mass_kg);
  return system;
}

}  // namespace glidelab::sim
