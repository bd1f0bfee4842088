#include "diagnose/fit/fit_step.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/math/dense.h"

namespace glidelab::diagnose {
namespace {

using Global = ParameterLayout::Global;

/// The least of y'Ay/2 - b'y, with the effects' parameters within their ranges: what would leave its range stops at the
/// edge, and the others make the best of that. `scale` times y is the change of the parameters.
Eigen::VectorXd step_within(const MotionFit& fit, Eigen::MatrixXd a, Eigen::VectorXd b, const Eigen::VectorXd& scale) {
  const auto& globals = fit.layout->globals();
  std::vector<bool> held(globals.size(), false);
  Eigen::VectorXd y = base::solve_positive(a, b);
  for (bool stopped = true; stopped;) {
    stopped = false;
    for (Eigen::Index g = 0; g < y.size(); ++g) {
      const Global& global = globals[static_cast<std::size_t>(g)];
      if (global.kind != Global::Kind::effect || held[static_cast<std::size_t>(g)]) continue;
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

/// What stopped at an edge lies there but for rounding.
void round_to_edges(const ParameterLayout& layout, Eigen::VectorXd& global) {
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const Global& of = layout.globals()[g];
    double& value = global[static_cast<Eigen::Index>(g)];
    if (of.kind == Global::Kind::effect) value = std::clamp(value, of.range.low, of.range.high);
  }
}

}  // namespace

FitPoint step_from(const MotionFit& fit, double damping) {
  const auto globals = fit.at.global.size();
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(globals, globals);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(globals), diagonal = right;
  std::vector<Eigen::MatrixXd> own_inverse, cross;
  std::vector<Eigen::VectorXd> own_right;
  for (const FitMotion& motion : fit.motions) {
    Eigen::MatrixXd own = base::transposed_product(motion.own, motion.own);
    for (Eigen::Index o = 0; o < own.rows(); ++o) own(o, o) = own(o, o) * (1.0 + damping) + 1e-12;
    const Eigen::MatrixXd inverse = base::inverse_positive(own);
    const Eigen::MatrixXd x = base::transposed_product(motion.global, motion.own);
    const Eigen::VectorXd r = base::transposed_product(motion.own, motion.residual);
    const Eigen::MatrixXd a = base::transposed_product(motion.global, motion.global);
    const Eigen::MatrixXd gain = base::product(x, inverse);
    diagonal += a.diagonal();
    normal += a - base::product(gain, x.transpose());
    right += base::transposed_product(motion.global, motion.residual);
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
  // Scaled, so that a parameter that the data hardly see does no harm to the others.
  const Eigen::VectorXd scale = (diagonal.array() + 1e-30).sqrt().inverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += damping + 1e-13;
  const Eigen::VectorXd change = scale.cwiseProduct(step_within(fit, scaled, scale.cwiseProduct(right), scale));
  FitPoint next = fit.at;
  next.global += change;
  round_to_edges(*fit.layout, next.global);
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const Eigen::VectorXd rest = own_right[i] - base::transposed_product(cross[i], change);
    next.own[i] += base::product(own_inverse[i], rest);
  }
  return next;
}

}  // namespace glidelab::diagnose
