#include "core/motion/smoothing/wiener_chain.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace glidelab::core {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Rows = Eigen::Matrix<double, 6, 7>;

constexpr double kFaded = 1e-10;   // of a row's largest weight
constexpr double kOneStep = 1e-9;  // steps that differ by less than this part are one step
constexpr double kSettled = 1e-9;  // gains and covariances that differ by less than this part are one

Matrix3d transition(double h) {
  Matrix3d f;
  f << 1.0, h, 0.5 * h * h, 0.0, 1.0, h, 0.0, 0.0, 1.0;
  return f;
}

/// An upper triangle R with R R' = cov w for q = 1.
Matrix3d noise_root(double h) {
  const double root = std::sqrt(h);
  Matrix3d upper = Matrix3d::Zero();
  upper(2, 2) = root;
  upper(1, 2) = h * root / 2.0;
  upper(0, 2) = h * h * root / 6.0;
  upper(1, 1) = h * root / std::sqrt(12.0);
  upper(0, 1) = h * h * root / (4.0 * std::sqrt(3.0));
  upper(0, 0) = h * h * root / (12.0 * std::sqrt(5.0));
  return upper;
}

/// Rotates the row (h, right) into the upper triangle; what is left of its right side.
double rotate_in(Matrix3d& upper, Vector3d& z, Vector3d row, double right) {
  for (int i = 0; i < 3; ++i) {
    if (row[i] == 0.0) continue;
    const double length = std::hypot(upper(i, i), row[i]);
    const double c = upper(i, i) / length, s = row[i] / length;
    for (int j = i; j < 3; ++j) {
      const double above = upper(i, j);
      upper(i, j) = c * above + s * row[j];
      row[j] = c * row[j] - s * above;
    }
    const double above = z[i];
    z[i] = c * above + s * right;
    right = c * right - s * above;
  }
  return right;
}

double log_square(double value) {
  return 2.0 * std::log(std::abs(value));
}

/// The part by which two matrices differ, beside the units of their entries.
bool alike(const Matrix3d& a, const Matrix3d& b, const Vector3d& row_unit, const Vector3d& column_unit) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (std::abs(a(i, j) - b(i, j)) > kSettled * row_unit[i] * column_unit[j]) return false;
    }
  }
  return true;
}

}  // namespace

ChainFit& ChainFit::operator+=(const ChainFit& other) {
  freedom += other.freedom;
  squares_m2 += other.squares_m2;
  log_determinant += other.log_determinant;
  return *this;
}

double ChainFit::minus_two_log_likelihood(double noise_variance_m2) const {
  return freedom * std::log(2.0 * std::numbers::pi * noise_variance_m2) + log_determinant +
         squares_m2 / noise_variance_m2;
}

/// What one step backwards needs: state_k = gain state_(k+1) + offset + root N(0, 1).
struct WienerChain::Step {
  Matrix3d gain;
  Vector3d offset;
  Matrix3d root;
};

WienerChain::WienerChain(const ChainData& data)
    : x_m_(data.x_m.begin(), data.x_m.end()), factor_(data.factor.begin(), data.factor.end()) {
  const std::size_t n = data.t_s.size();
  assert(n >= kFewestChainPoints && data.x_m.size() == n);
  if (factor_.empty()) factor_.assign(n, 1.0);
  assert(factor_.size() == n);
  origin_m_ = x_m_[n / 2];
  unit_s_ = (data.t_s.back() - data.t_s.front()) / static_cast<double>(n - 1);
  for (std::size_t i = 0; i < n; ++i) nodes_.push_back({data.t_s[i], i, false});
  for (const double t : data.at_s) nodes_.push_back({t, {}, false});
  for (const double t : data.breaks_s) {
    nodes_.push_back({t, {}, false});
    nodes_.push_back({t, {}, true});
  }
  std::stable_sort(nodes_.begin(), nodes_.end(), [](const auto& a, const auto& b) { return a.t_s < b.t_s; });
}

template <typename Visit>
ChainFit WienerChain::filter(const WienerRatio& ratio, Matrix3d& last, Vector3d& right, Visit&& visit) const {
  ChainFit fit;
  fit.freedom = -3.0;
  fit.log_determinant = 3.0 * log_square(unit_s_);  // v and a of which nothing is known are per second
  const double jerk = std::sqrt(ratio.jerk_1_s5 * std::pow(unit_s_, 5));
  const bool free_jump = std::isinf(ratio.jump_1_s2);
  const double jump = free_jump ? 1.0 : ratio.jump_1_s2 * unit_s_ * unit_s_;
  Matrix3d upper = Matrix3d::Zero();
  Vector3d z = Vector3d::Zero();
  Rows rows;
  Eigen::HouseholderQR<Rows> qr;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (k > 0) {
      const double h = (nodes_[k].t_s - nodes_[k - 1].t_s) / unit_s_;
      Matrix3d root = Matrix3d::Zero();
      if (nodes_[k].after_break) {
        root(2, 2) = jump;
      } else {
        root = jerk * noise_root(h);
      }
      const Matrix3d back = transition(-h);
      const Matrix3d known = upper * back;
      rows.setZero();
      rows.topLeftCorner<3, 3>().setIdentity();
      if (nodes_[k].after_break && free_jump) {
        rows(2, 2) = 0.0;
        fit.freedom -= 1.0;
        fit.log_determinant += 2.0 * log_square(unit_s_);
      }
      rows.bottomLeftCorner<3, 3>().noalias() = -known * root;
      rows.block<3, 3>(3, 3) = known;
      rows.block<3, 1>(3, 6) = z;
      qr.compute(rows);
      const auto& r = qr.matrixQR();
      upper = r.block<3, 3>(3, 3).template triangularView<Eigen::Upper>();
      z = r.block<3, 1>(3, 6);
      for (int i = 0; i < 3; ++i) fit.log_determinant += log_square(r(i, i));
      visit(k - 1, back, root, r);
    }
    if (nodes_[k].point) {
      const std::size_t i = *nodes_[k].point;
      const double per_noise = 1.0 / factor_[i];
      const double left = rotate_in(upper, z, Vector3d(per_noise, 0.0, 0.0), (x_m_[i] - origin_m_) * per_noise);
      fit.squares_m2 += left * left;
      fit.freedom += 1.0;
      fit.log_determinant -= log_square(per_noise);
    }
  }
  for (int i = 0; i < 3; ++i) fit.log_determinant += log_square(upper(i, i));
  last = upper;
  right = z;
  return fit;
}

ChainFit WienerChain::fit(const WienerRatio& ratio) const {
  Matrix3d last;
  Vector3d right;
  return filter(ratio, last, right, [](auto&&...) {});
}

ChainPosterior WienerChain::posterior(const WienerRatio& ratio) const {
  const std::size_t n = nodes_.size();
  ChainPosterior made;
  made.nodes_ = nodes_;
  made.x_m_ = x_m_;
  made.factor_ = factor_;
  std::vector<Step> steps(n - 1);
  Matrix3d last;
  Vector3d right;
  filter(ratio, last, right, [&](std::size_t k, const Matrix3d& back, const Matrix3d& root, const Rows& r) {
    const auto of_noise = r.topLeftCorner<3, 3>().triangularView<Eigen::Upper>();
    const Matrix3d spread = back * root;
    steps[k].root = of_noise.solve<Eigen::OnTheRight>(spread);
    steps[k].gain = back + steps[k].root * r.block<3, 3>(0, 3);
    steps[k].offset = -steps[k].root * r.block<3, 1>(0, 6);
  });
  const auto upper = last.triangularView<Eigen::Upper>();
  const Matrix3d inverse = upper.solve(Matrix3d(Matrix3d::Identity()));
  made.mean_.resize(n);
  made.covariance_.resize(n);
  made.mean_[n - 1] = inverse * right;
  made.covariance_[n - 1] = inverse * inverse.transpose();
  for (std::size_t k = n - 1; k-- > 0;) {
    made.mean_[k] = steps[k].gain * made.mean_[k + 1] + steps[k].offset;
    made.covariance_[k] =
        steps[k].gain * made.covariance_[k + 1] * steps[k].gain.transpose() + steps[k].root * steps[k].root.transpose();
  }
  // Back from the units within: x stays, v and a are per unit of time.
  const Vector3d unit(1.0, 1.0 / unit_s_, 1.0 / (unit_s_ * unit_s_));
  const Vector3d per_unit = unit.cwiseInverse();
  made.last_root_ = unit.asDiagonal() * inverse;
  made.gain_.resize(n - 1);
  made.root_.resize(n - 1);
  for (std::size_t k = 0; k < n; ++k) {
    made.mean_[k] = unit.asDiagonal() * made.mean_[k];
    made.mean_[k][0] += origin_m_;
    made.covariance_[k] = unit.asDiagonal() * made.covariance_[k] * unit.asDiagonal();
    if (k + 1 == n) break;
    made.gain_[k] = unit.asDiagonal() * steps[k].gain * per_unit.asDiagonal();
    made.root_[k] = unit.asDiagonal() * steps[k].root;
  }
  return made;
}

Matrix3d ChainPosterior::covariance(std::size_t k, std::size_t l) const {
  if (k > l) return covariance(l, k).transpose();
  Matrix3d between = covariance_[l];
  for (std::size_t i = l; i-- > k;) between = gain_[i] * between;
  return between;
}

double ChainPosterior::trace() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < size(); ++k) {
    if (!nodes_[k].point) continue;
    const double factor = factor_[*nodes_[k].point];
    sum += covariance_[k](0, 0) / (factor * factor);
  }
  return sum;
}

double ChainPosterior::residual_squares_m2() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < size(); ++k) {
    if (!nodes_[k].point) continue;
    const std::size_t i = *nodes_[k].point;
    const double off = (x_m_[i] - mean_[k][0]) / factor_[i];
    sum += off * off;
  }
  return sum;
}

std::vector<KernelRow> ChainPosterior::rows(const std::vector<std::size_t>& nodes) const {
  // settled[k]: nodes before k that look alike: uniform steps, all measured with one noise, the same gain and
  // covariance.
  std::vector<std::size_t> settled(size(), 0);
  for (std::size_t k = 2; k + 1 < size(); ++k) {
    const double step = nodes_[k].t_s - nodes_[k - 1].t_s, before = nodes_[k - 1].t_s - nodes_[k - 2].t_s;
    if (!nodes_[k].point || !nodes_[k - 1].point || std::abs(step - before) > kOneStep * step ||
        factor_[*nodes_[k].point] != factor_[*nodes_[k - 1].point]) {
      continue;
    }
    const Vector3d sd = covariance_[k].diagonal().cwiseSqrt();
    if (alike(covariance_[k], covariance_[k - 1], sd, sd) && alike(gain_[k], gain_[k - 1], sd, sd.cwiseInverse())) {
      settled[k] = settled[k - 1] + 1;
    }
  }
  std::vector<KernelRow> made;
  std::size_t known_node = 0, known_from = 0, known_to = 0;  // of the row before: its node, the nodes that it reaches
  for (const std::size_t j : nodes) {
    if (!made.empty() && j > known_node && nodes_[j].point) {
      const std::size_t by = j - known_node;
      if (known_to + by < size() && settled[known_to + by] >= known_to + by - known_from) {
        made.push_back({made.back().first + by, made.back().weights});
        known_node = j;
        known_from += by;
        known_to += by;
        continue;
      }
    }
    const Vector3d per_sd = covariance_[j].diagonal().cwiseSqrt().cwiseInverse();
    double largest = 0.0;
    std::vector<Vector3d> left, right;
    std::size_t first = x_m_.size(), from = j, to = j;
    const auto take = [&](std::size_t k, const Vector3d& with_x, std::vector<Vector3d>& side) {
      if (!nodes_[k].point) return true;
      const std::size_t i = *nodes_[k].point;
      side.push_back(with_x / (factor_[i] * factor_[i]));
      first = std::min(first, i);
      const double size_here = side.back().cwiseProduct(per_sd).cwiseAbs().maxCoeff();
      largest = std::max(largest, size_here);
      return size_here > kFaded * largest;
    };
    // cov(state_i, state_j) = G_i cov(state_(i+1), state_j) for i < j; to the other side the same from the left.
    Matrix3d between = covariance_[j];
    bool going = take(j, between.col(0), right);
    for (std::size_t k = j; going && k-- > 0;) {
      between = gain_[k] * between;
      going = take(k, between.row(0).transpose(), left);
      from = k;
    }
    going = true;
    Matrix3d product = Matrix3d::Identity();
    for (std::size_t k = j + 1; going && k < size(); ++k) {
      product = product * gain_[k - 1];
      going = take(k, product * covariance_[k].col(0), right);
      to = k;
    }
    KernelWeights weights;
    const auto put = [&](const Vector3d& w) {
      weights.x.push_back(w[0]);
      weights.v.push_back(w[1]);
      weights.a.push_back(w[2]);
    };
    std::for_each(left.rbegin(), left.rend(), put);
    std::for_each(right.begin(), right.end(), put);
    made.push_back({first, std::make_shared<const KernelWeights>(std::move(weights))});
    known_node = j;
    known_from = from;
    known_to = to;
  }
  return made;
}

}  // namespace glidelab::core
