#include "base/math/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>

namespace glidelab::base {

bool is_settled(FitStop stop) {
  return stop == FitStop::step_small || stop == FitStop::cost_settled;
}

std::string_view describe(FitStop stop) {
  switch (stop) {
    case FitStop::step_small:
      return "the last step is smaller than the tolerance";
    case FitStop::cost_settled:
      return "the last step changes the sum of squares by less than the tolerance";
    case FitStop::no_descent:
      return "no step lowers the sum of squares";
    case FitStop::iterations:
      return "the limit of iterations is reached";
    case FitStop::singular:
      return "the data do not determine all parameters";
    case FitStop::out_of_range:
      return "the model does not hold at these parameters";
    case FitStop::hopeless:
      return "the model is far from the data";
  }
  return "";
}

FitProgress::FitProgress(const FitOptions& options, double start_cost)
    : options_(options), start_cost_(start_cost), cost_(start_cost), damping_(options.damping_start) {
  if (!std::isfinite(start_cost)) {
    stop_ = FitStop::out_of_range;
  } else if (options.most_iterations <= 0) {
    stop_ = FitStop::iterations;
  }
}

bool FitProgress::judge(double cost, bool is_small) {
  ++iterations_;
  const bool ends_by_cost = options_.cost_absolute > 0.0 || options_.cost_relative >= 0.0;
  const double tolerance = options_.cost_absolute + std::max(options_.cost_relative, 0.0) * cost_;
  const bool is_flat = ends_by_cost && std::abs(cost_ - cost) <= tolerance && damping_ <= options_.damping_settled;
  const bool is_taken = options_.take_every_step || cost <= cost_;
  if (is_taken) {
    cost_ = cost;
    lower_damping();
  } else {
    raise_damping();
  }
  const bool may_settle = is_taken || options_.refused_may_settle;
  if (may_settle && is_small) {
    stop_ = FitStop::step_small;
  } else if (!is_taken && damping_ > options_.damping_most) {
    stop_ = FitStop::no_descent;
  } else if (may_settle && is_flat) {
    stop_ = FitStop::cost_settled;
  } else if (iterations_ >= options_.most_iterations) {
    stop_ = FitStop::iterations;
  }
  return is_taken;
}

void FitProgress::give_up(FitStop why) {
  stop_ = why;
}

FitSummary FitProgress::summary() const {
  return {stop_.value_or(FitStop::iterations), iterations_, start_cost_, cost_, damping_};
}

void FitProgress::lower_damping() {
  damping_ = std::max({options_.lower * damping_, options_.damping_least, floor_});
  floor_ *= options_.floor_decay;
}

void FitProgress::raise_damping() {
  floor_ = options_.floor_after_refusal * damping_;
  damping_ *= options_.raise;
}

}  // namespace glidelab::base
