/// Linear and nonlinear least squares: a line by its sums, orthogonal polynomials, and the Levenberg-Marquardt method
/// for small dense problems.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/math/levenberg_marquardt.h"

namespace glidelab::core {

/// Weighted least squares of a straight line y = intercept + slope x, by its sums:
///
///     slope = (W Sxy - Sx Sy) / D,    intercept = (Sxx Sy - Sx Sxy) / D,    D = W Sxx - Sx^2
struct LineSums {
  double w = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;

  void add(double weight, double at, double value) {
    w += weight;
    x += weight * at;
    y += weight * value;
    xx += weight * at * at;
    xy += weight * at * value;
  }
  double determinant() const { return w * xx - x * x; }
  /// If all x are equal, rounding alone leaves D at about 1e-16 of W Sxx; D must exceed the fraction `least` of W Sxx.
  bool is_regular(double least) const { return determinant() > least * w * xx; }
  double slope() const { return (w * xy - x * y) / determinant(); }
  double intercept() const { return (xx * y - x * xy) / determinant(); }
};

/// The square of the correlation of pairs, by Welford's update: no cancellation.
class PairCorrelation {
 public:
  void add(double x, double y) {
    n_ += 1.0;
    const double dx = x - mean_x_, dy = y - mean_y_;
    mean_x_ += dx / n_;
    mean_y_ += dy / n_;
    xx_ += dx * (x - mean_x_);
    xy_ += dx * (y - mean_y_);
    yy_ += dy * (y - mean_y_);
  }
  /// x and y have the same length.
  void add(std::span<const double> x, std::span<const double> y) {
    for (std::size_t i = 0; i < x.size(); ++i) add(x[i], y[i]);
  }
  /// 0 if all x or all y are equal.
  double squared() const { return xx_ > 0.0 && yy_ > 0.0 ? xy_ * xy_ / (xx_ * yy_) : 0.0; }

 private:
  double n_ = 0.0, mean_x_ = 0.0, mean_y_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
};

/// Polynomials that are orthogonal over given points and weights (Forsythe 1957): least squares without matrices.
///
///     p_0 = 1,   p_(k+1)(u) = (u - alpha_k) p_k(u) - beta_k p_(k-1)(u)
///     alpha_k = sum K u p_k^2 / N_k,   beta_k = N_k / N_(k-1),   N_k = sum K p_k^2
///
/// The weighted fit of values y is sum_k c_k p_k, c_k = sum K p_k y / N_k; for white noise of unit variance and K = 1
/// the c_k are independent, of variance 1 / N_k. u is best scaled to about 1.
class OrthogonalPolynomials {
 public:
  /// Empty if the points do not determine a polynomial of this order: a norm below 1e-11 of that of the power u^k.
  static std::optional<OrthogonalPolynomials> make(int order, std::span<const double> u,
                                                   std::span<const double> weights);

  int order() const { return static_cast<int>(norm_.size()) - 1; }
  double norm(int k) const { return norm_[static_cast<std::size_t>(k)]; }
  /// p_k at the points.
  std::span<const double> at_points(int k) const {
    return std::span(values_).subspan(static_cast<std::size_t>(k) * points_, points_);
  }
  /// The derivatives 0 … highest of all p_k at u: [k * (highest + 1) + d].
  std::vector<double> derivatives(double u, int highest) const;

 private:
  std::size_t points_ = 0;
  std::vector<double> values_, norm_, alpha_, beta_;
};

template <int N>
struct NormalEquations {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  Matrix jtj = Matrix::Zero();  ///< complete after complete(); only the lower half before
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

/// The step -(J^T W J + D)^-1 J^T W r, where D is the fraction `damping` of the diagonal plus 1e-12 of its largest
/// element: for any size, compiled once.
Eigen::VectorXd damped_step(const Eigen::Ref<const Eigen::MatrixXd>& jtj, const Eigen::Ref<const Eigen::VectorXd>& jtr,
                            double damping);

/// (J^T W J)^-1; empty if it is singular within rounding.
std::optional<Eigen::MatrixXd> inverse_of_equations(const Eigen::Ref<const Eigen::MatrixXd>& jtj);

template <int N>
struct LeastSquaresFit {
  Eigen::Matrix<double, N, 1> parameters;
  Eigen::Matrix<double, N, 1> evaluated_at;  ///< where J was evaluated: at the result, or before the last small step
  Eigen::Matrix<double, N, N> covariance;    ///< (J^T W J)^-1 times the residual variance
  double rms = 0.0;                          ///< sqrt(cost / (weight - N)): the residual standard deviation
  int iterations = 0;
  base::FitStop stop = base::FitStop::iterations;
};

/// The Levenberg-Marquardt method for small dense problems: it minimises sum_i w_i r_i(p)^2 over N parameters.
///
/// The caller evaluates residuals and their analytic Jacobian and adds them to the normal equations one by one, so that
/// nothing of the size of the data is stored. Units are the caller's. The loop is that of
/// base/math/levenberg_marquardt.h. It stops when a step changes every parameter by less than its `step` (an absolute
/// measure, one for each parameter), or changes the cost by less than a fraction 1e-7 (with n data this is a step of
/// sqrt(1e-7 n) standard deviations: a hundredth for a thousand pixels). Such a small step is taken without another
/// evaluation if it is hardly damped: the cost after it is that of the linear residuals.
///
/// `evaluate(p)` returns the NormalEquations at p, or an empty value if p is outside the model's range (the step is
/// then shortened). A residual is model minus datum. `is_hopeless(fit, equations)` is called before each step, with the
/// parameters and iterations so far; true ends the fit. The fit is singular if J^T W J has no inverse at its end.
template <int N, class Evaluate, class IsHopeless>
LeastSquaresFit<N> fit_least_squares(const Evaluate& evaluate, const Eigen::Matrix<double, N, 1>& start,
                                     const Eigen::Matrix<double, N, 1>& step, int max_iterations,
                                     const IsHopeless& is_hopeless) {
  using Vector = Eigen::Matrix<double, N, 1>;
  struct Point {
    Vector parameters, evaluated_at;
    NormalEquations<N> equations;
  };
  constexpr double kHardlyDamped = 1e-3;
  base::FitOptions options;
  options.most_iterations = max_iterations;
  options.damping_start = kHardlyDamped;
  options.lower = 0.2;
  options.raise = 8.0;
  options.cost_relative = 1e-7;
  options.refused_may_settle = true;

  LeastSquaresFit<N> fit;
  fit.parameters = fit.evaluated_at = start;
  fit.covariance.setZero();
  std::optional<NormalEquations<N>> at_start = evaluate(start);
  if (!at_start) {
    fit.stop = base::FitStop::out_of_range;
    return fit;
  }
  at_start->complete();
  Point here{start, start, *at_start};
  const auto try_step = [&](const Point& from, double damping) {
    base::FitTrial<Point> trial;
    fit.parameters = from.parameters;
    fit.evaluated_at = from.evaluated_at;
    if (is_hopeless(std::as_const(fit), from.equations)) {
      trial.why_none = base::FitStop::hopeless;
      return trial;
    }
    ++fit.iterations;
    const Vector delta = damped_step(from.equations.jtj, from.equations.jtr, damping);
    if (!delta.allFinite()) return trial;
    const Vector to = from.parameters + delta;
    trial.is_small = (delta.array().abs() < step.array()).all();
    if (trial.is_small && damping <= kHardlyDamped) {
      const double change = delta.dot(2.0 * from.equations.jtr + from.equations.jtj * delta);
      trial.cost = std::min(std::max(from.equations.cost + change, 0.0), from.equations.cost);
      trial.point = Point{to, from.evaluated_at, from.equations};
      trial.point->equations.cost = trial.cost;
      return trial;
    }
    std::optional<NormalEquations<N>> there = evaluate(to);
    if (there) {
      there->complete();
      trial.cost = there->cost;
    }
    trial.point = Point{to, to, there ? *there : NormalEquations<N>{}};
    return trial;
  };
  const base::FitSummary summary = base::levenberg_marquardt(here, here.equations.cost, options, try_step);
  fit.parameters = here.parameters;
  fit.evaluated_at = here.evaluated_at;
  fit.iterations = summary.iterations;
  fit.stop = summary.stop;
  if (fit.stop == base::FitStop::hopeless || fit.stop == base::FitStop::singular) return fit;
  const double freedom = here.equations.weight - N;
  if (freedom <= 0.0) {
    fit.stop = base::FitStop::singular;
    return fit;
  }
  fit.rms = std::sqrt(here.equations.cost / freedom);
  const std::optional<Eigen::MatrixXd> inverse = inverse_of_equations(here.equations.jtj);
  if (!inverse) {
    fit.stop = base::FitStop::singular;
    return fit;
  }
  fit.covariance = *inverse * (fit.rms * fit.rms);
  return fit;
}

template <int N, class Evaluate>
LeastSquaresFit<N> fit_least_squares(const Evaluate& evaluate, const Eigen::Matrix<double, N, 1>& start,
                                     const Eigen::Matrix<double, N, 1>& step, int max_iterations) {
  const auto never = [](const auto&, const auto&) { return false; };
  return fit_least_squares<N>(evaluate, start, step, max_iterations, never);
}

}  // namespace glidelab::core
