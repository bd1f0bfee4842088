#include "diagnose/fit/fit_neighbourhood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math/dense.h"
#include "base/math/log_sum.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {

OwnColumns own_columns(const FitMotion& motion) {
  OwnColumns own;
  own.scale = (motion.own.colwise().squaredNorm().transpose().array() + 1e-300).sqrt().inverse();
  own.scaled = motion.own * own.scale.asDiagonal();
  Eigen::MatrixXd normal = base::transposed_product(own.scaled, own.scaled);
  normal.diagonal().array() += 1e-12;
  own.gain = base::solve_positive(normal, own.scaled.transpose());
  return own;
}

Eigen::MatrixXd without_own(const FitMotion& motion, const base::MatrixView& columns) {
  const OwnColumns own = own_columns(motion);
  return columns - base::product(own.scaled, base::product(own.gain, columns));
}

ProjectedMotion project(const FitMotion& motion) {
  ProjectedMotion result;
  result.residual = without_own(motion, motion.residual);
  result.common = without_own(motion, motion.global);
  double points = 0.0;
  for (Eigen::Index p = 0; p < motion.own.rows(); ++p) points += motion.own(p, 0) != 0.0 ? 1.0 : 0.0;
  result.freedom = std::max(0.0, points - static_cast<double>(motion.own.cols()));
  return result;
}

void CommonNormal::add(const ProjectedMotion& motion) {
  matrix += base::transposed_product(motion.common, motion.common);
  right += base::transposed_product(motion.common, motion.residual);
}

void CommonNormal::add(const CommonNormal& others) {
  matrix += others.matrix;
  right += others.right;
}

std::vector<CommonNormal> without_each_clip(const TrackSet& set, const CommonNormal& stated,
                                            const std::vector<ProjectedMotion>& motions) {
  const std::size_t clips = set.clips.size();
  const CommonNormal nothing{Eigen::MatrixXd::Zero(stated.matrix.rows(), stated.matrix.cols()),
                             Eigen::VectorXd::Zero(stated.right.size())};
  std::vector<CommonNormal> of_clip(clips, nothing), without(clips, stated);
  for (std::size_t i = 0; i < motions.size(); ++i) of_clip[set.motions[i].clip].add(motions[i]);
  CommonNormal before = nothing, after = nothing;
  for (std::size_t c = 0; c < clips; ++c) {
    without[c].add(before);
    before.add(of_clip[c]);
  }
  for (std::size_t c = clips; c-- > 0;) {
    without[c].add(after);
    after.add(of_clip[c]);
  }
  return without;
}

CommonNormal statements_normal(const MotionFit& fit) {
  const auto n = fit.at.global.size();
  CommonNormal normal{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const FitStatement& s : fit.statements) {
    const auto g = static_cast<Eigen::Index>(s.global);
    normal.matrix(g, g) += 1.0 / (s.sd * s.sd);
    normal.right[g] += (s.value - fit.at.global[g]) / (s.sd * s.sd);
  }
  return normal;
}

Eigen::MatrixXd inverse_normal(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scale = (matrix.diagonal().array() + 1e-30).sqrt().inverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  scaled.diagonal().array() += 1e-12;
  const Eigen::MatrixXd inverse = base::inverse_positive(scaled);
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

namespace {

constexpr double kUnseen = 1e-10;
constexpr double kUndrawn = 1e-8;  // relative error of derivatives by finite differences: no size is resolved below
                                   // this

/// Orthonormal columns with the span of those of `a`; linearly dependent columns are dropped.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd q(a.rows(), a.cols());
  Eigen::Index kept = 0;
  for (Eigen::Index c = 0; c < a.cols(); ++c) {
    Eigen::VectorXd v = a.col(c);
    const double size = v.norm();
    if (!(size > 0.0) || !std::isfinite(size)) continue;
    v /= size;
    for (int twice = 0; twice < 2; ++twice) {
      for (Eigen::Index k = 0; k < kept; ++k) v -= q.col(k).dot(v) * q.col(k);
    }
    const double rest = v.norm();
    if (rest < 1e-7) continue;
    q.col(kept++) = v / rest;
  }
  return q.leftCols(kept);
}

}  // namespace

ScoreSpace::ScoreSpace(const TrackSet& set, const MotionFit& fit) : set_(set), fit_(fit) {
  const auto globals = fit.at.global.size();
  for (const FitMotion& motion : fit.motions) {
    offset_.push_back(points_);
    points_ += motion.residual.size();
    own_.push_back(orthonormal(motion.own));
  }
  Eigen::MatrixXd common(points_, globals);
  residual_.rest.resize(points_);
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const auto n = fit.motions[i].residual.size();
    const Eigen::MatrixXd along = base::transposed_product(own_[i], fit.motions[i].global);
    common.middleRows(offset_[i], n) = fit.motions[i].global - base::product(own_[i], along);
    const Eigen::VectorXd of_r = base::transposed_product(own_[i], fit.motions[i].residual);
    residual_.rest.segment(offset_[i], n) = fit.motions[i].residual - base::product(own_[i], of_r);
    base_.push_back(moved_by(i, model_of(set, *fit.layout, fit.at, i)).x_m);
  }
  Eigen::MatrixXd normal = base::transposed_product(common, common);
  Eigen::VectorXd right = base::transposed_product(common, residual_.rest);
  for (const FitStatement& s : fit.statements) {
    const auto g = static_cast<Eigen::Index>(s.global);
    normal(g, g) += 1.0 / (s.sd * s.sd);
    right[g] += (s.value - fit.at.global[g]) / (s.sd * s.sd);
  }
  // W with W' normal W = 1, without the directions that the data do not determine.
  const Eigen::VectorXd scale = (normal.diagonal().array() + 1e-30).sqrt().inverse();
  const base::SymmetricEigen eigen =
      base::symmetric_eigen(Eigen::MatrixXd(scale.asDiagonal() * normal * scale.asDiagonal()));
  Eigen::MatrixXd whiten = Eigen::MatrixXd::Zero(globals, globals);
  for (Eigen::Index g = 0; g < globals; ++g) {
    if (eigen.values[g] > 1e-11) whiten.col(g) = scale.cwiseProduct(eigen.vectors.col(g)) / std::sqrt(eigen.values[g]);
  }
  common_ = base::product(common, whiten);
  residual_.common = base::transposed_product(whiten, right);
}

Moved ScoreSpace::moved_by(std::size_t i, const TrackModel& model) const {
  return move(model, set_.motions[i].t_s, fit_.late.empty() ? std::span<const double>() : std::span(fit_.late[i]));
}

Eigen::VectorXd ScoreSpace::own_rest(std::size_t i, const Eigen::VectorXd& change_m) const {
  const std::vector<double> weights = weights_of(set_.motions[i]);
  Eigen::VectorXd c = change_m.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(weights.data(), change_m.size()));
  c = whitened(set_.motions[i], std::move(c));
  for (Eigen::Index q = 0; q < own_[i].cols(); ++q) c -= own_[i].col(q).dot(c) * own_[i].col(q);
  return c;
}

ScoreColumn ScoreSpace::project(const std::vector<Eigen::VectorXd>& by_motion) const {
  ScoreColumn column{Eigen::VectorXd::Zero(points_), {}};
  for (std::size_t i = 0; i < by_motion.size(); ++i) {
    if (by_motion[i].size() == 0) continue;
    column.rest.segment(offset_[i], by_motion[i].size()) = own_rest(i, by_motion[i]);
  }
  column.common = base::transposed_product(common_, column.rest);
  return column;
}

namespace {

Eigen::VectorXd difference(const std::vector<double>& a, const std::vector<double>& b, double step) {
  Eigen::VectorXd d(static_cast<Eigen::Index>(a.size()));
  for (std::size_t p = 0; p < a.size(); ++p) d[static_cast<Eigen::Index>(p)] = (a[p] - b[p]) / step;
  return d;
}

}  // namespace

std::vector<Eigen::VectorXd> ScoreSpace::changes_by(const std::vector<UnnamedForce>& forces, double size_n) const {
  std::vector<Eigen::VectorXd> changes(set_.motions.size());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!forces[i]) continue;
    const UnnamedForce small = [&](double x, double v, double t) { return size_n * forces[i](x, v, t); };
    const TrackModel model = model_of(set_, *fit_.layout, fit_.at, i, &small);
    changes[i] = difference(moved_by(i, model).x_m, base_[i], size_n);
  }
  return changes;
}

ScoreColumn ScoreSpace::of_force(const std::vector<UnnamedForce>& forces, double size_n) const {
  return project(changes_by(forces, size_n));
}

ScoreColumn ScoreSpace::of_effect(std::size_t effect, const std::vector<double>& shape) const {
  const auto& parameters = effect_list()[effect].parameters;
  std::vector<Eigen::VectorXd> changes(set_.motions.size());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    TrackModel model = model_of(set_, *fit_.layout, fit_.at, i);
    for (std::size_t s = 0; s < shape.size(); ++s) model.effects[parameters[s + 1].slot] = shape[s];
    double& size = model.effects[parameters[0].slot];
    const double kept = size, step = parameters[0].step;
    size = kept + step;
    const Moved above = moved_by(i, model);
    size = kept - step;
    changes[i] = difference(above.x_m, moved_by(i, model).x_m, 2.0 * step);
  }
  return project(changes);
}

ScoreColumn ScoreSpace::of_own(std::size_t i, EffectSlot size, double step, EffectSlot shape,
                               double shape_value) const {
  std::vector<Eigen::VectorXd> changes(set_.motions.size());
  TrackModel model = model_of(set_, *fit_.layout, fit_.at, i);
  model.effects[shape] = shape_value;
  model.effects[size] += step;
  changes[i] = difference(moved_by(i, model).x_m, base_[i], step);
  return project(changes);
}

ScoreColumn ScoreSpace::of_parameter(const ParameterLayout::Global& global) const {
  std::vector<Eigen::VectorXd> changes(set_.motions.size());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!touches(set_, global, i)) continue;
    TrackModel model = model_of(set_, *fit_.layout, fit_.at, i);
    double& size = model.effects[global.parameter->slot];
    const double absent = size;
    size = absent + global.step;
    const Moved above = moved_by(i, model);
    size = absent - global.step;
    changes[i] = difference(above.x_m, moved_by(i, model).x_m, 2.0 * global.step);
  }
  return project(changes);
}

SpreadSeen ScoreSpace::seen(const std::vector<ScoreColumn>& columns) const {
  const auto n = std::ssize(columns);
  Eigen::MatrixXd rest(points_, n), common(residual_.common.size(), n);
  for (Eigen::Index c = 0; c < n; ++c) {
    rest.col(c) = columns[static_cast<std::size_t>(c)].rest;
    common.col(c) = columns[static_cast<std::size_t>(c)].common;
  }
  SpreadSeen seen;
  seen.products = base::transposed_product(rest, rest) - base::transposed_product(common, common);
  seen.scores = base::transposed_product(rest, residual_.rest) - base::transposed_product(common, residual_.common);
  return seen;
}

double ScoreSpace::dot(const ScoreColumn& a, const ScoreColumn& b) const {
  return a.rest.dot(b.rest) - a.common.dot(b.common);
}

double log_amplitude_evidence(double z_hat, double z_most, bool both_signs) {
  constexpr double kLeast = 2.0;
  const double most = std::max(z_most, kLeast * 10.0);  // at least one decade
  const double width = std::log(most / kLeast);
  constexpr int kParts = 400;
  std::vector<double> logs;
  for (const int sign : {1, -1}) {
    if (sign < 0 && !both_signs) break;
    // On a grid in log z; if the peak is narrow on that scale, it is integrated as a Gaussian.
    const double z = sign * z_hat;
    if (z > 30.0) {
      if (z < most) logs.push_back(0.5 * z * z + 0.5 * std::log(2.0 * 3.14159265358979) - std::log(z * width));
      if (z >= most) logs.push_back(0.5 * z * z - 0.5 * std::pow(z - most, 2) - std::log(most * width));
      continue;
    }
    const double top = std::min(width, std::log(60.0 / kLeast));
    for (int i = 0; i < kParts; ++i) {
      const double at = kLeast * std::exp(top * (i + 0.5) / kParts);
      logs.push_back(at * z - 0.5 * at * at + std::log(top / kParts / width));
    }
  }
  return base::log_sum(logs) - (both_signs ? std::log(2.0) : 0.0);
}

SpreadEvidence log_spread_evidence(const Eigen::MatrixXd& products, const Eigen::VectorXd& scores) {
  SpreadEvidence result;
  if (!products.allFinite() || !scores.allFinite()) return result;
  const Eigen::Index n = scores.size();
  const base::SymmetricEigen eigen = base::symmetric_eigen(products);
  const double largest = eigen.values[n - 1];
  if (!(largest > 0.0)) return result;
  const Eigen::VectorXd along = base::transposed_product(eigen.vectors, scores);
  constexpr int kSizes = 14;  // tau sqrt(largest) from 2 to 2 10^(13/3): more than four decades
  std::vector<double> logs;
  double best = -std::numeric_limits<double>::infinity(), best_tau2 = 0.0;
  for (int k = 0; k < kSizes; ++k) {
    const double tau2 = std::pow(2.0 * std::pow(10.0, k / 3.0), 2) / largest;
    double log_evidence = 0.0, gain = 0.0;
    for (Eigen::Index j = 0; j < n; ++j) {
      const double lambda = eigen.values[j];
      if (lambda < kUnseen * largest) continue;  // absorbed by the fitted parameters; only rounding is left
      const double shrunk = tau2 / (1.0 + tau2 * lambda);
      gain += 0.5 * along[j] * along[j] * shrunk;
      log_evidence -= 0.5 * std::log1p(tau2 * lambda);
    }
    log_evidence += gain;
    logs.push_back(log_evidence);
    if (log_evidence > best) {
      best = log_evidence;
      best_tau2 = tau2;
      result.gain = gain;
    }
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    if (eigen.values[j] > kUnseen * largest) result.free_gain += 0.5 * along[j] * along[j] / eigen.values[j];
  }
  result.log_evidence = base::log_mean(logs);
  result.tau = std::sqrt(best_tau2);
  Eigen::VectorXd shrink(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const bool seen = eigen.values[j] >= kUndrawn * largest;
    shrink[j] = seen ? best_tau2 / (1.0 + best_tau2 * eigen.values[j]) : 0.0;
  }
  result.mean = base::product(eigen.vectors, shrink.cwiseProduct(along));
  result.covariance = base::product(Eigen::MatrixXd(eigen.vectors * shrink.asDiagonal()), eigen.vectors.transpose());
  return result;
}

}  // namespace glidelab::diagnose
