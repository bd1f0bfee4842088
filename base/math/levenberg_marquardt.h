/// Levenberg and Marquardt's descent: the one loop that every nonlinear least-squares fit runs.
///
/// It minimises a cost C(p), usually a weighted sum of squares of residuals r with Jacobian J. At the current point it
/// asks for a trial: the step of damped normal equations such as
///
///     (J'WJ + l diag J'WJ) dp = -J'W r,
///
/// It takes the step if C(p + dp) <= C(p), and then lowers the damping l; otherwise it stays and raises l. The caller
/// makes the step (small and dense, blocks eliminated, parameters held at the edge of their range), because the
/// structure of the equations differs from fit to fit. When to take a step and when to stop is decided here. The
/// damping's start, factors and limits are options, since each fit has its own.
///
/// Eigen's unsupported LevenbergMarquardt does not serve: it stores the Jacobian of all residuals, has no blocks to
/// eliminate, and stops at one tolerance common to all parameters.
///
/// Reference: K. Madsen, H. B. Nielsen, O. Tingleff, Methods for Non-Linear Least Squares Problems, 2nd ed.
/// (2004), 3.2.
#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace glidelab::base {

/// Why a fit ended. n is the number of trials so far; tolerances are those of FitOptions.
enum class FitStop {
  step_small,    ///< the trial reports |dp_k| < tolerance_k for every parameter k
  cost_settled,  ///< |C(p + dp) - C(p)| <= cost_absolute + cost_relative C(p), at a damping <= damping_settled
  no_descent,    ///< l > damping_most: no step lowers the cost by more than rounding, or the Jacobian is wrong
  iterations,    ///< n >= most_iterations
  singular,      ///< the normal equations determine no finite step
  out_of_range,  ///< C(start) is not finite, or the trial left the range in which the model holds
  hopeless,      ///< the caller gave up
};

/// True if the fit is at a minimum to within its tolerances: step_small and cost_settled.
bool is_settled(FitStop stop);

/// In words, for messages.
std::string_view describe(FitStop stop);

struct FitOptions {
  int most_iterations = 50;  ///< trials, taken or refused
  double damping_start = 1e-3;
  double damping_least = 1e-9;
  double damping_most = 1e8;
  double lower = 0.1;  ///< factor on the damping after a step that was taken
  double raise = 10.0;
  /// After a refused step the damping falls no lower than this factor times the refused damping; each step taken lowers
  /// that floor by `floor_decay`. 0: no floor. In a narrow curved valley it saves a fit every other step.
  double floor_after_refusal = 0.0;
  double floor_decay = 1.0;
  double cost_absolute = 0.0;
  double cost_relative = -1.0;  ///< negative, with cost_absolute = 0: the cost never ends the fit
  double damping_settled = std::numeric_limits<double>::infinity();
  bool refused_may_settle = false;  ///< a refused step also ends the fit if it is small or the cost is settled
  bool take_every_step = false;     ///< the undamped Gauss-Newton method: costs are not compared
};

struct FitSummary {
  FitStop stop = FitStop::iterations;
  int iterations = 0;  ///< trials, taken or refused
  double start_cost = 0.0;
  double cost = 0.0;
  double damping = 0.0;  ///< after the last trial
};

/// The decisions of the loop, one trial after another.
class FitProgress {
 public:
  FitProgress(const FitOptions& options, double start_cost);
  bool goes_on() const { return !stop_; }
  double damping() const { return damping_; }
  /// True if the step is to be taken. A cost that is not finite is refused.
  bool judge(double cost, bool is_small);
  void give_up(FitStop why);
  FitSummary summary() const;

 private:
  void lower_damping();
  void raise_damping();
  FitOptions options_;
  std::optional<FitStop> stop_;
  int iterations_ = 0;
  double start_cost_;
  double cost_;
  double damping_;
  double floor_ = 0.0;
};

/// Where a step leads.
template <class Point>
struct FitTrial {
  std::optional<Point> point;  ///< empty: there is no step, for the reason in `why_none`
  double cost = std::numeric_limits<double>::infinity();
  bool is_small = false;  ///< every parameter changes by less than its tolerance
  FitStop why_none = FitStop::singular;
};

/// Starts from `here` with its cost. `try_step(here, damping)` makes a FitTrial<Point>; it may store in `here` what it
/// needs for the next trial, such as a Jacobian. Leaves the best point in `here`.
template <class Point, class TryStep>
FitSummary levenberg_marquardt(Point& here, double cost, const FitOptions& options, TryStep&& try_step) {
  FitProgress progress(options, cost);
  while (progress.goes_on()) {
    FitTrial<Point> trial = try_step(here, progress.damping());
    if (!trial.point) {
      progress.give_up(trial.why_none);
    } else if (progress.judge(trial.cost, trial.is_small)) {
      here = std::move(*trial.point);
    }
  }
  return progress.summary();
}

}  // namespace glidelab::base
