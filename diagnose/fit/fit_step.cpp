#include "diagnose/fit/fit_step.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/math/dense.h"

namespace glidelab::diagnose {

bool has_range(const ParameterLayout::Global& global) {
  using Kind = ParameterLayout::Global::Kind;
  return global.kind == Kind::effect || global.kind == Kind::k || global.kind == Kind::alpha ||
         global.kind == Kind::gravity;
}

double fastest_start(const TrackedMotion& motion) {
  constexpr double kFaster = 3.0, kNoise = 5.0;
  double fastest = 0.0;
  for (std::size_t p = 1; p < motion.t_s.size(); ++p) {
    const double distance =
        std::abs(motion.x_m[p] - motion.x_m[p - 1]) + kNoise * (motion.sd_of(p - 1) + motion.sd_of(p));
    fastest = std::max(fastest, distance / (motion.t_s[p] - motion.t_s[p - 1]));
  }
  return kFaster * fastest;
}

void keep_within(const TrackSet& set, const ParameterLayout& layout, FitPoint& at) {
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const ParameterLayout::Global& of = layout.globals()[g];
    double& value = at.global[static_cast<Eigen::Index>(g)];
    if (has_range(of)) value = std::clamp(value, of.range.low, of.range.high);
  }
  for (std::size_t i = 0; i < at.own.size(); ++i) {
    const double most = fastest_start(set.motions[i]);
    at.own[i][kStartSpeed] = std::clamp(at.own[i][kStartSpeed], -most, most);
  }
}

namespace {

/// The minimum of y'Ay/2 - b'y with the effects' parameters within their ranges: a parameter that would leave its range
/// stops at the edge, and the others minimise what remains. `scale` times y is the change of the parameters.
Eigen::VectorXd step_within(const MotionFit& fit, Eigen::MatrixXd a, Eigen::VectorXd b, const Eigen::VectorXd& scale) {
  const auto& globals = fit.layout->globals();
  std::vector<bool> held(globals.size(), false);
  Eigen::VectorXd y = base::solve_positive(a, b);
  for (bool stopped = true; stopped;) {
    stopped = false;
    for (Eigen::Index g = 0; g < y.size(); ++g) {
      const ParameterLayout::Global& global = globals[static_cast<std::size_t>(g)];
      if (!has_range(global) || held[static_cast<std::size_t>(g)]) continue;
      const double at = fit.at.global[g], next = at + scale[g] * y[g];
      if (!(next < global.range.low || next > global.range.high)) continue;
      const double to_edge = ((next < global.range.low ? global.range.low : global.range.high) - at) / scale[g];
      b -= to_edge * a.col(g);
      a.col(g).setZero();
      a.row(g).setZero();
      a(g, g) = 1.0;
      b[g] = to_edge;
      held[static_cast<std::size_t>(g)] = stopped = true;
    }
    if (stopped) y = base::solve_positive(a, b);
  }
  return y;
}

/// The derivatives of a motion with respect to its own parameters and its residuals, while some of these parameters
/// take steps that are given.
struct OwnPart {
  Eigen::MatrixXd own;
  Eigen::VectorXd residual;
  std::optional<double> speed_step;  ///< that of the start's speed, which stops at its limit

  explicit OwnPart(const FitMotion& motion) : own(motion.own), residual(motion.residual) {}
  void hold_speed(double step) {
    residual -= step * own.col(kStartSpeed);
    own.col(kStartSpeed).setZero();
    speed_step = step;
  }
};

/// The step with starts free but for those that are held.
FitPoint step_with(const MotionFit& fit, const std::vector<OwnPart>& parts, double damping) {
  const auto globals = fit.at.global.size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(globals, globals);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(globals), diagonal = right;
  std::vector<Eigen::MatrixXd> own_inverse, cross;
  std::vector<Eigen::VectorXd> own_right;
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const FitMotion& motion = fit.motions[i];
    const OwnPart& part = parts[i];
    Eigen::MatrixXd own = base::transposed_product(part.own, part.own);
    for (Eigen::Index o = 0; o < own.rows(); ++o) own(o, o) = own(o, o) * (1.0 + damping) + 1e-12;
    const Eigen::MatrixXd inverse = base::inverse_positive(own);
    const Eigen::MatrixXd x = base::transposed_product(motion.global, part.own);
    const Eigen::VectorXd r = base::transposed_product(part.own, part.residual);
    const Eigen::MatrixXd a = base::transposed_product(motion.global, motion.global);
    const Eigen::MatrixXd gain = base::product(x, inverse);
    diagonal += a.diagonal();
    normal += a - base::product(gain, x.transpose());
    right += base::transposed_product(motion.global, part.residual);
    right -= base::product(gain, r);
    own_inverse.push_back(inverse);
    cross.push_back(x);
    own_right.push_back(r);
  }
  for (const FitStatement& s : fit.statements) {
    const auto g = static_cast<Eigen::Index>(s.global);
    const double weight = 1.0 / (s.sd * s.sd);
    normal(g, g) += weight;
    diagonal[g] += weight;
    right[g] += weight * (s.value - fit.at.global[g]);
  }
  // Scaled, so that parameters that the data hardly determine do not harm the others.
  const Eigen::VectorXd scale = (diagonal.array() + 1e-30).sqrt().inverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += damping + 1e-13;
  const Eigen::VectorXd change = scale.cwiseProduct(step_within(fit, scaled, scale.cwiseProduct(right), scale));
  FitPoint next = fit.at;
  next.global += change;
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const Eigen::VectorXd rest = own_right[i] - base::transposed_product(cross[i], change);
    next.own[i] += base::product(own_inverse[i], rest);
    if (parts[i].speed_step) next.own[i][kStartSpeed] = fit.at.own[i][kStartSpeed] + *parts[i].speed_step;
  }
  return next;
}

}  // namespace

FitPoint step_from(const TrackSet& set, const MotionFit& fit, double damping) {
  std::vector<OwnPart> parts(fit.motions.begin(), fit.motions.end());
  FitPoint next = step_with(fit, parts, damping);
  for (bool stopped = true; stopped;) {
    stopped = false;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const double most = fastest_start(set.motions[i]), speed = next.own[i][kStartSpeed];
      if (parts[i].speed_step || !(std::abs(speed) > most)) continue;
      parts[i].hold_speed(std::copysign(most, speed) - fit.at.own[i][kStartSpeed]);
      stopped = true;
    }
    if (stopped) next = step_with(fit, parts, damping);
  }
  keep_within(set, *fit.layout, next);  // what stopped at an edge differs from it by rounding
  return next;
}

}  // namespace glidelab::diagnose
