#include "core/motion/free/event_time.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

#include "base/math/levenberg_marquardt.h"
#include "core/motion/smoothing/noise.h"

namespace glidelab::core {
namespace {

constexpr int kSteps = 40;
constexpr double kSettled = 1e-9;        // a step of t*, of the window
constexpr double kAlmostSettled = 1e-4;  // will do after kSteps
constexpr double kFarthest = 0.8;        // t* from the window's middle
constexpr std::ptrdiff_t kFewestOnASide = 5;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// x*, t*, a and j before, a and j after; times in windows about `near`.
struct Fit {
  Vector6 parameters = Vector6::Zero();
  Matrix6 normal = Matrix6::Zero();
  double squares = 0.0;
};

/// Columns that a stop does not have are kept at zero by a one on the diagonal.
void pin(Matrix6& normal, EventKind kind) {
  if (kind == EventKind::turns) return;
  for (const int i : {4, 5}) {
    normal.row(i).setZero();
    normal.col(i).setZero();
    normal(i, i) = 1.0;
  }
}

Vector6 design_at(const Vector6& p, double u, EventKind kind) {
  Vector6 d = Vector6::Zero();
  d[0] = 1.0;
  const int side = u < 0.0 ? 2 : 4;
  if (side == 4 && kind == EventKind::stops) return d;
  d[1] = -(p[side] * u + 0.5 * p[side + 1] * u * u);  // - v
  d[side] = 0.5 * u * u;
  d[side + 1] = u * u * u / 6.0;
  return d;
}

double place_at(const Vector6& p, double u, EventKind kind) {
  const int side = u < 0.0 ? 2 : 4;
  if (side == 4 && kind == EventKind::stops) return p[0];
  return p[0] + 0.5 * p[side] * u * u + p[side + 1] * u * u * u / 6.0;
}

/// Best linear parameters at t*.
Fit linear_fit(const std::vector<double>& u, const std::vector<double>& x, double at, EventKind kind) {
  Fit fit;
  Vector6 right = Vector6::Zero();
  for (std::size_t i = 0; i < u.size(); ++i) {
    Vector6 d = design_at(Vector6::Zero(), u[i] - at, kind);
    fit.normal += d * d.transpose();
    right += d * x[i];
  }
  fit.normal(1, 1) = 1.0;  // t* is held
  pin(fit.normal, kind);
  fit.parameters = fit.normal.ldlt().solve(right);
  fit.parameters[1] = at;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double off = x[i] - place_at(fit.parameters, u[i] - at, kind);
    fit.squares += off * off;
  }
  return fit;
}

}  // namespace

std::optional<EventTime> estimate_event(std::span<const double> t_s, std::span<const double> x_m, EventKind kind,
                                        double near_s, double window_s, const std::vector<double>& autocovariance) {
  std::vector<double> u, x;
  double mean = 0.0;
  std::ptrdiff_t before = 0, after = 0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (std::abs(t_s[i] - near_s) > window_s) continue;
    u.push_back((t_s[i] - near_s) / window_s);
    x.push_back(x_m[i]);
    mean += x_m[i];
    ++(u.back() < 0.0 ? before : after);
  }
  if (before < kFewestOnASide || after < kFewestOnASide) return {};
  mean /= static_cast<double>(x.size());
  for (double& value : x) value -= mean;

  // The sum of squares over t* may have more than one valley: the best of a coarse walk, then Gauss and Newton.
  Fit best = linear_fit(u, x, 0.0, kind);
  for (int i = -12; i <= 12; ++i) {
    const Fit fit = linear_fit(u, x, 0.05 * i, kind);
    if (fit.squares < best.squares) best = fit;
  }
  struct Point {
    Vector6 p;
    Matrix6 normal;  // before the step that led here
    double moved;    // by that step, of t*
  };
  base::FitOptions options;
  options.most_iterations = kSteps;
  options.take_every_step = true;  // the coarse walk ends so close by that no step needs to be held back
  const auto try_step = [&](const Point& here, double) {
    Matrix6 normal = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    for (std::size_t i = 0; i < u.size(); ++i) {
      const Vector6 d = design_at(here.p, u[i] - here.p[1], kind);
      normal += d * d.transpose();
      right += d * (x[i] - place_at(here.p, u[i] - here.p[1], kind));
    }
    pin(normal, kind);
    const Vector6 change = normal.ldlt().solve(right);
    base::FitTrial<Point> trial;
    if (!change.allFinite()) return trial;
    const Vector6 next = here.p + change;
    trial.why_none = base::FitStop::out_of_range;
    if (std::abs(next[1]) > kFarthest) return trial;
    trial.point = Point{next, normal, std::abs(change[1])};
    trial.cost = 0.0;  // not compared
    trial.is_small = trial.point->moved <= kSettled;
    return trial;
  };
  Point found{best.parameters, Matrix6::Identity(), 1.0};
  const base::FitStop stop = base::levenberg_marquardt(found, 0.0, options, try_step).stop;
  if (stop == base::FitStop::singular || stop == base::FitStop::out_of_range || found.moved > kAlmostSettled) return {};
  const Vector6& p = found.p;
  const bool right_signs = kind == EventKind::stops ? p[2] != 0.0 : p[2] * p[4] > 0.0;
  if (!right_signs) return {};
  const double variance = sum_over_lags(autocovariance);
  const Matrix6 inverse = found.normal.ldlt().solve(Matrix6::Identity());
  EventTime event;
  event.t_s = near_s + window_s * p[1];
  event.sd_s = window_s * std::sqrt(std::max(0.0, variance * inverse(1, 1)));
  event.x_m = mean + p[0];
  event.before_m_s2 = p[2] / (window_s * window_s);
  event.after_m_s2 = kind == EventKind::stops ? 0.0 : p[4] / (window_s * window_s);
  return event;
}

}  // namespace glidelab::core
