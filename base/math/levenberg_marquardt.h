/// Levenberg and Marquardt's descent: the one loop that every nonlinear least-squares fit runs.
///
/// It minimises a cost C(p), mostly a weighted sum of squares of residuals r with Jacobian J. From where it stands it
/// asks for a trial: the step of damped normal equations such as
///
///     (J'WJ + l diag J'WJ) dp = -J'W r,
///
/// takes the step where C(p + dp) <= C(p), and then lowers the damping l; otherwise it stays and raises l. How a step
/// is made is the caller's (small and dense, blocks eliminated, parameters held at the edge of their range), for the
/// structure of the equations differs from fit to fit; when to take one and when to stop is decided here. Damping
/// rules: start, factors and limits as options, since each fit has its own.
///
/// Eigen's unsupported LevenbergMarquardt does not serve: it stores the Jacobian of all residuals, has no blocks to
/// eliminate, and stops by a tolerance that is common to all parameters.
///
/// Reference: K. Madsen, H. B. Nielsen, O. Tingleff, Methods for Non-Linear Least Squares Problems, 2nd ed.
/// (2004), 3.2.
#pragma once

#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace glidelab::base {

/// Why a fit ended; n is the number of trials so far, tolerances are those of FitOptions.
enum class FitStop {
  step_small,    ///< the trial says |dp_k| < tolerance_k for every parameter k
  cost_settled,  ///< |C(p + dp) - C(p)| <= cost_absolute + cost_relative C(p), at a damping <= damping_settled
  no_descent,    ///< l > damping_most: no step lowers the cost by more than rounding, or the Jacobian is wrong
  iterations,    ///< n >= most_iterations
  singular,      ///< the normal equations determine no finite step
  out_of_range,  ///< C(start) is not finite, or the trial left the range in which the model holds
  hopeless,      ///< the caller gave up
};

/// True where the fit stands at a minimum to within its tolerances: step_small and cost_settled.
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
  /// After a refused step the damping falls no lower than this factor times the refused one; each step taken lowers
  /// that floor by `floor_decay`. 0: no floor. It spares a fit in a narrow bent valley every other step.
  double floor_after_refusal = 0.0;
  double floor_decay = 1.0;
  double cost_absolute = 0.0;
  double cost_relative = -1.0;  ///< negative, with cost_absolute = 0: the cost never ends the fit
  double damping_settled = std::numeric_limits<double>::infinity();
  bool refused_may_settle = false;  ///< a refused step ends the fit as well, where it is small or the cost is settled
  bool take_every_step = false;     ///< Gauss and Newton's undamped method: costs are not compared
};

struct FitSummary {
  FitStop stop = FitStop::iterations;
  int iterations = 0;  ///< trials, taken or refused
  double start_cost = 0.0;
  double cost = 0.0;
  double damping = 0.0;  ///< after the last trial
};

/// The decisions of the loop, one trial after the other.
class FitProgress {
 public:
  FitProgress(const FitOptions& options, double start_cost);
  bool goes_on() const { return !stop_; }
  double damping() const { return damping_; }
  /// True where the step is to be taken. A cost that is not finite is refused.
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
  std::optional<Point> point;  ///< nothing: there is no step, for the reason in `why_none`
  double cost = std::numeric_limits<double>::infinity();
  bool is_small = false;  ///< every parameter changes by less than matters
  FitStop why_none = FitStop::singular;
};

/// From `here` with its cost. `try_step(here, damping)` makes a FitTrial<Point>; it may keep in `here` what it needs
/// for the next one, such as a Jacobian. Leaves the best point in `here`.
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
