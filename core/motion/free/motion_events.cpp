#include "core/motion/free/motion_events.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/math/dense.h"
#include "base/math/levenberg_marquardt.h"
#include "core/math/quantile.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/motion/smoothing/noise.h"

namespace glidelab::core {
namespace {

constexpr double kMostNoiseShare = 0.10;           // largest noise of a, as a fraction of the median |a|
constexpr double kLeastMovingPerBandwidth = 12.0;  // largest bandwidth: the moving time over this
constexpr double kGrowth = 1.15;                   // ratio of successive bandwidths
constexpr double kStillDeviations = 5.0;           // of v: one point in 1e6 by chance

/// Robust standard deviation of x about the smoothed x; more than the pilot noise if the noise is correlated.
double residual_noise(const Motion& motion, const std::vector<std::optional<SmoothedPoint>>& smoothed,
                      double weight_of_own_point) {
  std::vector<double> off;
  for (std::size_t j = 0; j < smoothed.size(); ++j) {
    if (smoothed[j]) off.push_back(std::abs(motion.y_m[j] - smoothed[j]->x_m));
  }
  // var(r) = s^2 (1 - own weight) for white noise: sum of squared weights is the own weight for a projection, and
  // nearly so here.
  return kSdOverMedian * quantile(off, 0.5) / std::sqrt(std::max(0.1, 1.0 - weight_of_own_point));
}

Pilot smooth_at(const Motion& motion, double bandwidth_s) {
  const LocalCubic cubic(motion.t_s, bandwidth_s);
  const std::size_t n = motion.t_s.size();
  const auto of_y = cubic.smooth(motion.y_m);
  const auto of_x = motion.forced ? cubic.smooth(motion.x_m) : of_y;
  const double own = std::min(0.9, 0.6 * motion.step_s / bandwidth_s);  // 3 / (2 sqrt(2 pi)) dt / h
  const double noise = std::max(motion.noise_m, residual_noise(motion, of_y, own));
  Pilot pilot;
  pilot.bandwidth_s = bandwidth_s;
  pilot.x_m = motion.x_m;
  pilot.v_m_s.assign(n, 0.0);
  pilot.a_m_s2.assign(n, 0.0);
  pilot.sd_v_m_s.assign(n, std::numeric_limits<double>::infinity());
  pilot.sd_a_m_s2 = pilot.sd_v_m_s;
  RowVariance variance({noise * noise});
  std::vector<double> speeds;
  for (std::size_t j = 0; j < n; ++j) {
    if (!of_y[j]) continue;
    const auto row = cubic.row_of_point(j);
    pilot.x_m[j] = of_x[j]->x_m;
    pilot.v_m_s[j] = of_x[j]->v_m_s;
    pilot.a_m_s2[j] = of_y[j]->a_m_s2;
    pilot.sd_v_m_s[j] = std::sqrt(variance.of_v(*row));
    pilot.sd_a_m_s2[j] = std::sqrt(variance.of_a(*row));
    speeds.push_back(std::abs(pilot.v_m_s[j]));
  }
  pilot.top_speed_m_s = quantile(speeds, 0.95);
  return pilot;
}

}  // namespace

double still_below(const Pilot& pilot, std::size_t point) {
  return std::max(kStillDeviations * pilot.sd_v_m_s[point], kStillShare * pilot.top_speed_m_s);
}

Pilot first_smoothing(const Motion& motion) {
  double bandwidth = 2.0 * motion.step_s;
  for (;;) {
    Pilot pilot = smooth_at(motion, bandwidth);
    std::vector<double> magnitude, noise;
    for (std::size_t j = 0; j < motion.t_s.size(); ++j) {
      if (std::abs(pilot.v_m_s[j]) <= still_below(pilot, j)) continue;
      magnitude.push_back(std::abs(pilot.a_m_s2[j]));
      noise.push_back(pilot.sd_a_m_s2[j]);
    }
    const double moving_s = motion.step_s * static_cast<double>(std::max(magnitude.size(), motion.t_s.size() / 4));
    const bool quiet = !magnitude.empty() && quantile(noise, 0.5) <= kMostNoiseShare * quantile(magnitude, 0.5);
    if (quiet || kGrowth * bandwidth > moving_s / kLeastMovingPerBandwidth) return pilot;
    bandwidth *= kGrowth;
  }
}

namespace {

constexpr double kLeastMotion = 20.0;    // a run must cover this many standard deviations of a position to be motion
constexpr double kRestBandwidths = 3.0;  // a reversal is still for less than one pilot bandwidth
constexpr std::size_t kRestPoints = 6;
constexpr double kRestGrowth = 3.0;  // standard deviations of a position

class RunFinder {
 public:
  RunFinder(const Motion& motion, const Pilot& pilot)
      : motion_(motion), pilot_(pilot), direction_(motion.t_s.size(), 0), resting_(motion.t_s.size(), 0) {}

  MotionRuns find() {
    assign_significant();
    find_rests();
    settle_between_runs();
    MotionRuns runs;
    for (std::size_t i = 1; i < direction_.size(); ++i) {
      if (direction_[i] * direction_[i - 1] < 0) runs.turns_s.push_back(motion_.t_s[i]);
      if (resting_[i] != resting_[i - 1]) runs.rest_edges_s.push_back(motion_.t_s[i]);
    }
    runs.direction = std::move(direction_);
    return runs;
  }

 private:
  double span_s(const PointRange& range) const { return motion_.t_s[range.to - 1] - motion_.t_s[range.from]; }
  double least_distance() const { return kLeastMotion * motion_.noise_m; }
  double distance_over(const PointRange& range) const { return pilot_.x_m[range.to - 1] - pilot_.x_m[range.from]; }

  void assign_significant() {
    for (std::size_t i = 0; i < direction_.size(); ++i) {
      if (std::abs(pilot_.v_m_s[i]) > still_below(pilot_, i)) direction_[i] = pilot_.v_m_s[i] > 0.0 ? 1 : -1;
    }
    for (const PointRange& run : ranges_of(direction_)) {
      if (direction_[run.from] == 0) continue;
      const auto begin = motion_.x_m.begin();
      const auto [low, high] = std::minmax_element(begin + static_cast<std::ptrdiff_t>(run.from),
                                                   begin + static_cast<std::ptrdiff_t>(run.to));
      if (*high - *low < least_distance()) fill_range(direction_, run, 0);
    }
  }

  /// Whether x has almost no slope and curvature in the middle part of the range.
  bool is_rest(const PointRange& range) const {
    if (range.size() < kRestPoints || span_s(range) < kRestBandwidths * pilot_.bandwidth_s) return false;
    const std::size_t cut = range.size() / 5;
    const PointRange middle{range.from + cut, range.to - cut};
    const auto count = static_cast<Eigen::Index>(middle.size());
    const double half_s = 0.5 * span_s(middle), centre_s = motion_.t_s[middle.from] + half_s;
    Eigen::MatrixXd design(count, 3);
    Eigen::VectorXd x(count);
    for (Eigen::Index r = 0; r < count; ++r) {
      const std::size_t i = middle.from + static_cast<std::size_t>(r);
      const double u = (motion_.t_s[i] - centre_s) / half_s;
      design.row(r) << 1.0, u, u * u;
      x[r] = motion_.x_m[i] - motion_.x_m[middle.from];
    }
    const Eigen::Vector3d fit = base::least_squares(design, x);
    // fit[1] is the distance over half the range, fit[2] the deviation of its ends. "Almost none" is a fifth of the
    // speed that counts as still, or what a position's noise covers.
    const double little = std::max(0.2 * kStillShare * pilot_.top_speed_m_s * half_s, kRestGrowth * motion_.noise_m);
    return std::abs(fit[1]) <= little && std::abs(fit[2]) <= little;
  }

  void find_rests() {
    for (const PointRange& range : ranges_of(direction_)) {
      if (direction_[range.from] != 0) continue;
      if (range.size() == direction_.size()) {
        // Nowhere is v significant. Yet a slow motion with gaps covers its distance: settle() gives it its direction.
        if (std::abs(distance_over(range)) < least_distance()) rest(range);
        break;
      }
      if (is_rest(range)) grow_rest(range);
    }
    for (std::size_t i = 0; i < direction_.size(); ++i) {
      if (resting_[i]) direction_[i] = 0;
    }
  }

  void grow_rest(const PointRange& range) {
    const std::size_t cut = range.size() / 5;
    PointRange grown{range.from + cut, range.to - cut};
    const auto begin = motion_.x_m.begin();
    const double place =
        quantile({begin + static_cast<std::ptrdiff_t>(grown.from), begin + static_cast<std::ptrdiff_t>(grown.to)}, 0.5);
    const auto near = [&](std::size_t i) {
      return i < motion_.x_m.size() && std::abs(motion_.x_m[i] - place) <= kRestGrowth * motion_.noise_m;
    };
    // One point off may be noise, two are not.
    while (grown.from > 0 && (near(grown.from - 1) || (grown.from > 1 && near(grown.from - 2)))) --grown.from;
    while (grown.to < motion_.x_m.size() && (near(grown.to) || near(grown.to + 1))) ++grown.to;
    rest(grown);
  }

  void rest(const PointRange& range) { fill_range(resting_, range, char{1}); }

  /// Points without significant v that do not rest belong to the run before or after.
  void settle_between_runs() {
    for (const PointRange& range : ranges_of(direction_)) {
      if (direction_[range.from] != 0) continue;
      for (std::size_t i = range.from; i < range.to; ++i) {
        if (resting_[i]) continue;
        PointRange part{i, i};
        while (part.to < range.to && !resting_[part.to]) ++part.to;
        settle(part, i > 0 ? direction_[i - 1] : 0, part.to < direction_.size() ? direction_[part.to] : 0);
        i = part.to - 1;
      }
    }
  }

  void settle(const PointRange& range, int before, int after) {
    if (before == after && before != 0) return fill_range(direction_, range, before);
    if (before == 0 && after == 0) {
      const double distance = distance_over(range);
      if (std::abs(distance) < least_distance()) return rest(range);
      return fill_range(direction_, range, distance > 0.0 ? 1 : -1);
    }
    // x is largest (smallest) where a motion towards +x (-x) turns, or where one towards -x (+x) begins.
    const int outward = before != 0 ? before : -after;
    std::size_t turn = range.from;
    for (std::size_t i = range.from; i < range.to; ++i) {
      if (outward * (pilot_.x_m[i] - pilot_.x_m[turn]) > 0.0) turn = i;
    }
    const PointRange first{range.from, turn}, second{turn, range.to};
    if (before != 0 && after != 0) {
      fill_range(direction_, first, before);
      return fill_range(direction_, second, after);
    }
    // One side is an end of the data or a rest. A piece that covers too little distance there to be motion is rest, if
    // it is long.
    const int known = before != 0 ? before : after;
    const PointRange& outer = before != 0 ? first : second;
    const PointRange& inner = before != 0 ? second : first;
    fill_range(direction_, outer, known);
    if (inner.size() == 0) return;
    if (std::abs(distance_over(inner)) >= least_distance()) {
      return fill_range(direction_, inner, -known);
    }
    if (span_s(inner) < kRestBandwidths * pilot_.bandwidth_s) return fill_range(direction_, inner, known);
    rest(inner);
  }

  const Motion& motion_;
  const Pilot& pilot_;
  std::vector<int> direction_;
  std::vector<char> resting_;
};

}  // namespace

MotionRuns find_runs(const Motion& motion, const Pilot& pilot) {
  return RunFinder(motion, pilot).find();
}

namespace {

constexpr int kSteps = 40;
constexpr double kSettled = 1e-9;        // a step of t*, as a fraction of the window
constexpr double kAlmostSettled = 1e-4;  // suffices after kSteps
constexpr double kFarthest = 0.8;        // largest distance of t* from the window's middle
constexpr std::ptrdiff_t kFewestOnASide = 5;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// x*, t*, a and j before, a and j after; times in windows about `near`.
struct Fit {
  Vector6 parameters = Vector6::Zero();
  Matrix6 normal = Matrix6::Zero();
  double squares = 0.0;
};

/// Columns that a stop does not have are held at zero by a one on the diagonal.
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
  fit.normal(1, 1) = 1.0;  // t* is held fixed
  pin(fit.normal, kind);
  fit.parameters = base::solve_positive(fit.normal, right);
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

  // The sum of squares over t* may have more than one valley: a coarse scan finds the best, then Gauss-Newton refines
  // it.
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
  options.take_every_step = true;  // the coarse scan ends so close that no step needs damping
  const auto try_step = [&](const Point& here, double) {
    Matrix6 normal = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
    for (std::size_t i = 0; i < u.size(); ++i) {
      const Vector6 d = design_at(here.p, u[i] - here.p[1], kind);
      normal += d * d.transpose();
      right += d * (x[i] - place_at(here.p, u[i] - here.p[1], kind));
    }
    pin(normal, kind);
    const Vector6 change = base::solve_positive(normal, right);
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
  const Matrix6 inverse = base::inverse_positive(found.normal);
  EventTime event;
  event.t_s = near_s + window_s * p[1];
  event.sd_s = window_s * std::sqrt(std::max(0.0, variance * inverse(1, 1)));
  event.x_m = mean + p[0];
  event.before_m_s2 = p[2] / (window_s * window_s);
  event.after_m_s2 = kind == EventKind::stops ? 0.0 : p[4] / (window_s * window_s);
  return event;
}

}  // namespace glidelab::core
