/// Levenberg-Marquardt for small dense problems: minimise sum_i w_i r_i(p)^2 over N parameters.
///
/// The caller evaluates residuals and their analytic Jacobian and adds them to the normal equations one by one, so that
/// nothing of the size of the data is stored. Units are the caller's. Stops when a step changes every parameter by less
/// than its `step` (an absolute measure, one for each parameter), or changes the cost by less than 1e-7 of itself (with
/// n data that is a step of sqrt(1e-7 n) standard deviations: a hundredth for a thousand pixels). So small a step is
/// taken without another evaluation where it is hardly damped: the cost after it is that of the linear residuals.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace glidelab::core {

template <int N>
struct NormalEquations {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  Matrix jtj = Matrix::Zero();  ///< whole once complete() was called; its lower half until then
  Vector jtr = Vector::Zero();
  double cost = 0.0;    ///< sum of w r^2
  double weight = 0.0;  ///< sum of w

  void add(const Vector& jacobian, double residual, double w) {
    for (int column = 0; column < N; ++column) {
      const double weighted = w * jacobian[column];
      for (int row = column; row < N; ++row) jtj(row, column) += weighted * jacobian[row];
    }
    jtr += (w * residual) * jacobian;
    cost += w * residual * residual;
    weight += w;
  }
  void complete() { jtj.template triangularView<Eigen::StrictlyUpper>() = jtj.transpose(); }
};

enum class FitStop { converged, iterations, singular, out_of_range, hopeless };

template <int N>
struct LeastSquaresFit {
  Eigen::Matrix<double, N, 1> parameters;
  Eigen::Matrix<double, N, 1> evaluated_at;  ///< where J was taken: there, or the last small step before
  Eigen::Matrix<double, N, N> covariance;    ///< (J^T W J)^-1 times the residual variance
  double rms = 0.0;                          ///< sqrt(cost / (weight - N)): the residual standard deviation
  int iterations = 0;
  FitStop stop = FitStop::iterations;
};

/// `evaluate(p)` gives the NormalEquations at p, or nothing where p is outside the model's range (the step is then
/// shortened). A residual is model minus datum. `is_hopeless(fit, equations)` is asked before each step, with the
/// parameters and iterations so far, and ends the fit.
template <int N, class Evaluate, class IsHopeless>
LeastSquaresFit<N> fit_least_squares(const Evaluate& evaluate, const Eigen::Matrix<double, N, 1>& start,
                                     const Eigen::Matrix<double, N, 1>& step, int max_iterations,
                                     const IsHopeless& is_hopeless) {
  using Vector = Eigen::Matrix<double, N, 1>;
  LeastSquaresFit<N> fit;
  fit.parameters = fit.evaluated_at = start;
  fit.covariance.setZero();
  std::optional<NormalEquations<N>> here = evaluate(start);
  if (!here) {
    fit.stop = FitStop::out_of_range;
    return fit;
  }
  here->complete();
  constexpr double kFlat = 1e-7;
  constexpr double kHardlyDamped = 1e-3;
  double damping = kHardlyDamped;
  for (; fit.iterations < max_iterations; ++fit.iterations) {
    if (is_hopeless(std::as_const(fit), std::as_const(*here))) {
      fit.stop = FitStop::hopeless;
      return fit;
    }
    Eigen::Matrix<double, N, N> damped = here->jtj;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-12 * here->jtj.diagonal().maxCoeff();
    const Vector delta = -damped.ldlt().solve(here->jtr);
    if (!delta.allFinite()) {
      fit.stop = FitStop::singular;
      return fit;
    }
    const Vector trial = fit.parameters + delta;
    const bool small = (delta.array().abs() < step.array()).all();
    if (small && damping <= kHardlyDamped) {
      fit.parameters = trial;
      here->cost = std::max(here->cost + delta.dot(2.0 * here->jtr + here->jtj * delta), 0.0);
      fit.stop = FitStop::converged;
      break;
    }
    std::optional<NormalEquations<N>> there = evaluate(trial);
    if (there) there->complete();
    const bool flat = there && std::abs(here->cost - there->cost) <= kFlat * here->cost;
    if (there && there->cost <= here->cost) {
      fit.parameters = fit.evaluated_at = trial;
      here = there;
      damping = std::max(damping * 0.2, 1e-9);
    } else {
      damping *= 8.0;
      if (damping > 1e8 && !small) break;
    }
    if (small || flat) {
      fit.stop = FitStop::converged;
      break;
    }
  }
  const double freedom = here->weight - N;
  if (freedom <= 0.0) {
    fit.stop = FitStop::singular;
    return fit;
  }
  fit.rms = std::sqrt(here->cost / freedom);
  // What has no inverse, as FullPivLU says it: of a matrix without negative eigenvalues both take the same pivots.
  const Eigen::LDLT<Eigen::Matrix<double, N, N>> factor(here->jtj);
  const auto pivots = factor.vectorD().cwiseAbs();
  if (!(pivots.minCoeff() > N * std::numeric_limits<double>::epsilon() * pivots.maxCoeff())) {
    fit.stop = FitStop::singular;
    return fit;
  }
  fit.covariance = factor.solve(Eigen::Matrix<double, N, N>::Identity()) * (fit.rms * fit.rms);
  return fit;
}

template <int N, class Evaluate>
LeastSquaresFit<N> fit_least_squares(const Evaluate& evaluate, const Eigen::Matrix<double, N, 1>& start,
                                     const Eigen::Matrix<double, N, 1>& step, int max_iterations) {
  const auto never = [](const auto&, const auto&) { return false; };
  return fit_least_squares<N>(evaluate, start, step, max_iterations, never);
}

}  // namespace glidelab::core
