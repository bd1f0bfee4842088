#include "core/motion/smoothing/wiener_chain.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/motion/smoothing/process_step.h"

namespace glidelab::core {
namespace {

constexpr double kFaded = 1e-10;   // of a row's largest weight
constexpr double kOneStep = 1e-9;  // steps that differ by less than this fraction count as equal
constexpr double kSettled = 1e-9;  // gains and covariances that differ by less than this fraction count as equal

template <int N>
using Square = Eigen::Matrix<double, N, N>;
template <int N>
using Column = Eigen::Matrix<double, N, 1>;

/// Rotates the row (h, right) into the upper triangle; returns the remainder of its right side.
template <int N>
double rotate_in(Square<N>& upper, Column<N>& z, Column<N> row, double right) {
  for (int i = 0; i < N; ++i) {
    if (row[i] == 0.0) continue;
    const double length = std::sqrt(upper(i, i) * upper(i, i) + row[i] * row[i]);
    const double c = upper(i, i) / length, s = row[i] / length;
    for (int j = i; j < N; ++j) {
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

/// The rows of one step: N for the noise of the step and N for the previous state; columns for both and the right side.
template <int N>
using StepRows = Eigen::Matrix<double, 2 * N, 2 * N + 1>;

/// The upper triangle of rows whose top left is diagonal and whose top right is 0, by reflections of the entries that
/// are not 0.
template <int N>
void triangulate(StepRows<N>& rows) {
  const auto reflect = [&](int pivot, int below, int count, int column) {
    double tail = 0.0;
    for (int r = 0; r < count; ++r) tail += rows(below + r, column) * rows(below + r, column);
    if (tail == 0.0) return;
    const double top = rows(pivot, column);
    const double length = std::copysign(std::sqrt(top * top + tail), top);
    const double first = top + length;
    const double scale = 1.0 / (length * first);  // 2 / |(first, tail)|^2
    for (int c = column + 1; c < 2 * N + 1; ++c) {
      double dot = first * rows(pivot, c);
      for (int r = 0; r < count; ++r) dot += rows(below + r, column) * rows(below + r, c);
      dot *= scale;
      rows(pivot, c) -= dot * first;
      for (int r = 0; r < count; ++r) rows(below + r, c) -= dot * rows(below + r, column);
    }
    rows(pivot, column) = -length;
    for (int r = 0; r < count; ++r) rows(below + r, column) = 0.0;
  };
  for (int i = 0; i < N; ++i) reflect(i, N, N, i);
  for (int i = 0; i < N; ++i) reflect(N + i, N + i + 1, N - 1 - i, N + i);
}

/// Far from ends and breaks, over uniform times, the filter's triangle no longer changes, and a step is linear in z and
/// in the position.
template <int N>
struct Steady {
  bool reached = false;
  Square<N> next = Square<N>::Zero(),
            noise = Square<N>::Zero();  // maps z to z of the next node, and z to the right side of the step's noise
  Column<N> next_of_y = Column<N>::Zero(),
            left = Column<N>::Zero();  // coefficients of the position over its noise; the innovation as a function of z
  double left_of_y = 0.0, log_determinant = 0.0;

  Steady() = default;
  /// Built from the rows of a step before they are made triangular.
  Steady(const StepRows<N>& whole, double per_noise) : reached(true) {
    const Column<N> row = per_noise * Column<N>::Unit(0);
    Square<N> upper;
    for (int i = 0; i < N; ++i) {
      StepRows<N> rows = whole;
      rows.template block<N, 1>(N, 2 * N) = Column<N>::Unit(i);
      triangulate<N>(rows);
      noise.col(i) = rows.template block<N, 1>(0, 2 * N);
      Column<N> z = rows.template block<N, 1>(N, 2 * N);
      upper = rows.template block<N, N>(N, N);
      Square<N> turned = upper;
      left[i] = rotate_in<N>(turned, z, row, 0.0);
      next.col(i) = z;
    }
    Column<N> z = Column<N>::Zero();
    left_of_y = rotate_in<N>(upper, z, row, 1.0);
    next_of_y = z;
  }
};

template <int N>
bool settled(const Square<N>& upper, const Square<N>& before) {
  constexpr double kUnchanged = 1e-12;
  for (int j = 0; j < N; ++j) {
    if (!((upper.col(j) - before.col(j)).norm() <= kUnchanged * upper.col(j).norm())) return false;
  }
  return upper(N - 1, N - 1) != 0.0;
}

double log_square(double value) {
  return 2.0 * std::log(std::abs(value));
}

/// The relative difference of two matrices, with the units of their entries taken into account.
template <int N>
bool alike(const Square<N>& a, const Square<N>& b, const Column<N>& row_unit, const Column<N>& column_unit) {
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
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

/// Data for one backward step: state_k = gain state_(k+1) + offset + root N(0, 1).
template <int N>
struct WienerChain<N>::Step {
  Matrix gain;
  Vector offset;
  Matrix root;
};

template <int N>
WienerChain<N>::WienerChain(const ChainData& data)
    : x_m_(data.x_m.begin(), data.x_m.end()), factor_(data.factor.begin(), data.factor.end()) {
  const std::size_t n = data.t_s.size();
  assert(n >= N && data.x_m.size() == n);
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

template <int N>
template <typename Visit>
ChainFit WienerChain<N>::filter(const WienerRatio& ratio, Matrix& last, Vector& right, Visit&& visit) const {
  ChainFit fit;
  fit.freedom = -N;
  fit.log_determinant = 0.5 * N * (N - 1) * log_square(unit_s_);  // the unknown (diffuse) parameters are in SI units
  const double root_density = std::sqrt(ratio.density * std::pow(unit_s_, 2 * N - 1));
  const double rate = ratio.rate_1_s * unit_s_;
  ProcessSteps<N> steps(rate);
  const bool free_jump = std::isinf(ratio.jump_1_s2);
  const double jump_time = free_jump ? 1.0 : ratio.jump_time_s / unit_s_;
  const double jump = free_jump ? 1.0 : ratio.jump_1_s2 * unit_s_ * unit_s_;
  Matrix upper = Matrix::Zero();
  Vector z = Vector::Zero();
  StepRows<N> rows;
  Matrix root = Matrix::Zero(), back = Matrix::Identity();
  Steady<N> steady;
  double h_before = 0.0, factor_before = 0.0;
  const auto measure = [&](std::size_t k) {
    if (!nodes_[k].point) return;
    const std::size_t i = *nodes_[k].point;
    const double per_noise = 1.0 / factor_[i];
    const double left = rotate_in<N>(upper, z, per_noise * Vector::Unit(0), (x_m_[i] - origin_m_) * per_noise);
    fit.squares_m2 += left * left;
    fit.freedom += 1.0;
    fit.log_determinant -= log_square(per_noise);
  };
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (k > 0) {
      const double h = (nodes_[k].t_s - nodes_[k - 1].t_s) / unit_s_;
      const bool like_before = nodes_[k].point && !nodes_[k].after_break && std::abs(h - h_before) <= kOneStep * h &&
                               factor_[*nodes_[k].point] == factor_before;
      h_before = nodes_[k].point ? h : 0.0;
      factor_before = nodes_[k].point ? factor_[*nodes_[k].point] : 0.0;
      if (steady.reached && like_before) {
        rows.template block<N, 1>(0, 2 * N) = steady.noise * z;
        visit(k - 1, back, root, rows);
        const std::size_t i = *nodes_[k].point;
        const double y = (x_m_[i] - origin_m_) / factor_[i], left = steady.left.dot(z) + steady.left_of_y * y;
        z = (steady.next * z + steady.next_of_y * y).eval();
        fit.squares_m2 += left * left;
        fit.freedom += 1.0;
        fit.log_determinant += steady.log_determinant;
        continue;
      }
      const Matrix upper_before = upper;
      const double determinant_before = fit.log_determinant;
      steady.reached = false;
      root.setZero();
      back.setIdentity();
      if (nodes_[k].after_break) {
        for (int d = 2; d < N; ++d) {
          root(d, d) = jump / std::pow(jump_time, d - 2);
          for (int e = d + 1; e < N; ++e) root(e, d) = -rate * root(e - 1, d);
        }
      } else {
        const ProcessStep<N>& step = steps.of(h);
        root = root_density * step.root;
        back = step.back;
        fit.log_determinant -= 2.0 * rate * h;  // of back
      }
      const Matrix known = upper * back;
      rows.setZero();
      rows.template topLeftCorner<N, N>().setIdentity();
      if (nodes_[k].after_break && free_jump) {
        for (int d = 2; d < N; ++d) {
          rows(d, d) = 0.0;
          fit.freedom -= 1.0;
          fit.log_determinant += d * log_square(unit_s_);
        }
      }
      rows.template bottomLeftCorner<N, N>().noalias() = -known * root;
      rows.template block<N, N>(N, N) = known;
      rows.template block<N, 1>(N, 2 * N) = z;
      const StepRows<N> whole = rows;
      triangulate<N>(rows);
      upper = rows.template block<N, N>(N, N);
      z = rows.template block<N, 1>(N, 2 * N);
      double determinant = 1.0;
      for (int i = 0; i < N; ++i) determinant *= rows(i, i);
      fit.log_determinant += log_square(determinant);
      visit(k - 1, back, root, rows);
      measure(k);
      if (like_before && settled<N>(upper, upper_before)) {
        steady = Steady<N>(whole, 1.0 / factor_before);
        steady.log_determinant = fit.log_determinant - determinant_before;
      }
    } else {
      measure(k);
    }
  }
  for (int i = 0; i < N; ++i) fit.log_determinant += log_square(upper(i, i));
  last = upper;
  right = z;
  return fit;
}

template <int N>
ChainFit WienerChain<N>::fit(const WienerRatio& ratio) const {
  Matrix last;
  Vector right;
  return filter(ratio, last, right, [](auto&&...) {});
}

template <int N>
ChainPosterior<N> WienerChain<N>::posterior(const WienerRatio& ratio) const {
  const std::size_t n = nodes_.size();
  ChainPosterior<N> made;
  made.nodes_ = nodes_;
  made.x_m_ = x_m_;
  made.factor_ = factor_;
  std::vector<Step> steps(n - 1);
  Matrix last;
  Vector right;
  filter(ratio, last, right, [&](std::size_t k, const Matrix& back, const Matrix& root, const auto& r) {
    const auto of_noise = r.template topLeftCorner<N, N>().template triangularView<Eigen::Upper>();
    const Matrix spread = back * root;
    steps[k].root = of_noise.template solve<Eigen::OnTheRight>(spread);
    steps[k].gain = back + steps[k].root * r.template block<N, N>(0, N);
    steps[k].offset = -steps[k].root * r.template block<N, 1>(0, 2 * N);
  });
  const auto upper = last.template triangularView<Eigen::Upper>();
  const Matrix inverse = upper.solve(Matrix(Matrix::Identity()));
  made.mean_.resize(n);
  made.covariance_.resize(n);
  made.mean_[n - 1] = inverse * right;
  made.covariance_[n - 1] = inverse * inverse.transpose();
  for (std::size_t k = n - 1; k-- > 0;) {
    made.mean_[k] = steps[k].gain * made.mean_[k + 1] + steps[k].offset;
    made.covariance_[k] =
        steps[k].gain * made.covariance_[k + 1] * steps[k].gain.transpose() + steps[k].root * steps[k].root.transpose();
  }
  // Converts back from internal units: derivatives are per unit of time.
  Vector unit;
  for (int d = 0; d < N; ++d) unit[d] = std::pow(unit_s_, -d);
  const Vector per_unit = unit.cwiseInverse();
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

template <int N>
Eigen::Matrix<double, N, N> ChainPosterior<N>::covariance(std::size_t k, std::size_t l) const {
  if (k > l) return covariance(l, k).transpose();
  Matrix between = covariance_[l];
  for (std::size_t i = l; i-- > k;) between = gain_[i] * between;
  return between;
}

template <int N>
double ChainPosterior<N>::trace() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < size(); ++k) {
    if (!nodes_[k].point) continue;
    const double factor = factor_[*nodes_[k].point];
    sum += covariance_[k](0, 0) / (factor * factor);
  }
  return sum;
}

template <int N>
double ChainPosterior<N>::residual_squares_m2() const {
  double sum = 0.0;
  for (std::size_t k = 0; k < size(); ++k) {
    if (!nodes_[k].point) continue;
    const std::size_t i = *nodes_[k].point;
    const double off = (x_m_[i] - mean_[k][0]) / factor_[i];
    sum += off * off;
  }
  return sum;
}

template <int N>
std::vector<KernelRow> ChainPosterior<N>::rows(const std::vector<std::size_t>& nodes) const {
  // settled[k]: number of equivalent nodes before k: uniform steps, all measured with one noise, the same gain and
  // covariance.
  std::vector<std::size_t> settled(size(), 0);
  for (std::size_t k = 2; k + 1 < size(); ++k) {
    const double step = nodes_[k].t_s - nodes_[k - 1].t_s, before = nodes_[k - 1].t_s - nodes_[k - 2].t_s;
    if (!nodes_[k].point || !nodes_[k - 1].point || std::abs(step - before) > kOneStep * step ||
        factor_[*nodes_[k].point] != factor_[*nodes_[k - 1].point]) {
      continue;
    }
    const Vector sd = covariance_[k].diagonal().cwiseSqrt();
    if (alike<N>(covariance_[k], covariance_[k - 1], sd, sd) &&
        alike<N>(gain_[k], gain_[k - 1], sd, sd.cwiseInverse())) {
      settled[k] = settled[k - 1] + 1;
    }
  }
  std::vector<KernelRow> made;
  std::size_t known_node = 0, known_from = 0, known_to = 0;  // of the previous row: its node, the nodes that it reaches
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
    const Eigen::Vector3d per_sd = covariance_[j].diagonal().template head<3>().cwiseSqrt().cwiseInverse();
    double largest = 0.0;
    std::vector<Eigen::Vector3d> left, right;
    std::size_t first = x_m_.size(), from = j, to = j;
    const auto take = [&](std::size_t k, const Eigen::Vector3d& with_x, std::vector<Eigen::Vector3d>& side) {
      if (!nodes_[k].point) return true;
      const std::size_t i = *nodes_[k].point;
      side.push_back(with_x / (factor_[i] * factor_[i]));
      first = std::min(first, i);
      const double size_here = side.back().cwiseProduct(per_sd).cwiseAbs().maxCoeff();
      largest = std::max(largest, size_here);
      return size_here > kFaded * largest;
    };
    // cov(state_i, state_j) = G_i cov(state_(i+1), state_j) for i < j; on the other side the same from the left.
    Matrix between = covariance_[j];
    bool going = take(j, between.col(0).template head<3>(), right);
    for (std::size_t k = j; going && k-- > 0;) {
      between = gain_[k] * between;
      going = take(k, between.row(0).template head<3>().transpose(), left);
      from = k;
    }
    going = true;
    Matrix product = Matrix::Identity();
    for (std::size_t k = j + 1; going && k < size(); ++k) {
      product = product * gain_[k - 1];
      going = take(k, (product * covariance_[k].col(0)).template head<3>(), right);
      to = k;
    }
    KernelWeights weights;
    const auto put = [&](const Eigen::Vector3d& w) {
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

template class WienerChain<3>;
template class WienerChain<4>;
template class WienerChain<5>;
template class ChainPosterior<3>;
template class ChainPosterior<4>;
template class ChainPosterior<5>;

}  // namespace glidelab::core
