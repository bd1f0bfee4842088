#include "sim/sensitivity/sensitivity.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "base/errors.h"

namespace glidelab::sim {

namespace {

Mode mode_at_rest(const MotionLaw& law, double x_m) {
  const double load = law.load_m_s2(x_m);
  if (std::abs(load) <= law.holding_m_s2(x_m)) return Mode::stick;
  return load < 0.0 ? Mode::slide_up : Mode::slide_down;
}

class SensitiveMotion {
 public:
  SensitiveMotion(const MotionLaw& law, double x0_m, double v0_m_s, std::span<const double> times_s,
                  const SolverOptions& options)
      : law_(law), times_s_(times_s), options_(options), count_(law.parameter_count() + 2) {
    if (2 + 2 * count_ > kMostComponents)
      throw std::logic_error("a law with too many parameters for its sensitivities");
    // y = (x, v, Sx of each, Sv of each)
    y_ = OdeVector::Zero(2 + 2 * count_);
    y_[0] = x0_m;
    y_[1] = v0_m_s;
    y_[2 + count_ - 2] = 1.0;           // x by x0
    y_[2 + count_ + count_ - 1] = 1.0;  // v by v0
    mode_ = v0_m_s < 0.0 ? Mode::slide_up : v0_m_s > 0.0 ? Mode::slide_down : mode_at_rest(law, x0_m);
    if (v0_m_s == 0.0 && mode_ == Mode::stick) y_.tail(count_).setZero();
  }

  std::vector<SensitiveState> run() {
    while (states_.size() < times_s_.size()) {
      if (mode_ == Mode::stick) {
        record();
      } else {
        slide();
      }
    }
    return std::move(states_);
  }

 private:
  void record() {
    SensitiveState state;
    state.t_s = times_s_[states_.size()];
    state.x_m = y_[0];
    state.v_m_s = mode_ == Mode::stick ? 0.0 : y_[1];
    state.mode = mode_;
    state.by_parameter.resize(2, count_);
    state.by_parameter.row(0) = y_.segment(2, count_).transpose();
    state.by_parameter.row(1) = y_.tail(count_).transpose();
    states_.push_back(std::move(state));
  }

  OdeVector rate(const OdeVector& y, int direction) const {
    const LawValue law = law_.sliding(y[0], y[1], direction);
    OdeVector rate(y.size());
    rate[0] = y[1];
    rate[1] = law.a_m_s2;
    const auto sx = y.segment(2, count_), sv = y.tail(count_);
    rate.segment(2, count_) = sv;
    rate.tail(count_) = law.by_x_1_s2 * sx + law.by_v_1_s * sv;
    rate.segment(2 + count_, count_ - 2) += law.by_parameter;
    return rate;
  }

  OdeSystem system(int direction) const {
    OdeSystem system;
    system.rate = [this, direction](const OdeVector& y) { return rate(y, direction); };
    system.event = [](const OdeVector& y) { return y[1]; };
    system.event_crossing = -direction;
    system.relative_tolerance = options_.relative_tolerance;
    system.absolute_tolerance = OdeVector::Constant(y_.size(), options_.absolute_tolerance);
    return system;
  }

  /// To v = 0, or to the last time.
  void slide() {
    const int direction = static_cast<int>(mode_);
    const double shortest = 8.0 * std::numeric_limits<double>::epsilon();
    while (states_.size() < times_s_.size() && times_s_[states_.size()] - t_s_ <= shortest * times_s_[states_.size()]) {
      record();
    }
    if (states_.size() == times_s_.size()) return;
    if (solver_) {
      solver_->restart(system(direction), t_s_, y_);
    } else {
      solver_.emplace(system(direction), t_s_, y_);
    }
    while (states_.size() < times_s_.size()) {
      const OdeState reached = solver_->advance(times_s_[states_.size()]);
      t_s_ = reached.t_s;
      y_ = reached.y;
      if (reached.at_event) return come_to_rest(direction);
      record();
    }
  }

  void come_to_rest(int direction) {
    const double before = law_.sliding(y_[0], 0.0, direction).a_m_s2;
    mode_ = mode_at_rest(law_, y_[0]);
    if (mode_ == static_cast<Mode>(direction)) {
      throw base::NumericalError(
          fmt::format("at t = {} s the law stops the glider and sets it off again in the same direction", t_s_));
    }
    y_[1] = 0.0;
    const double after = mode_ == Mode::stick ? 0.0 : law_.sliding(y_[0], 0.0, static_cast<int>(mode_)).a_m_s2;
    y_.tail(count_) *= after / before;
  }

  const MotionLaw& law_;
  std::span<const double> times_s_;
  SolverOptions options_;
  int count_;
  double t_s_ = 0.0;
  OdeVector y_;
  Mode mode_;
  std::optional<CvodesSolver> solver_;
  std::vector<SensitiveState> states_;
};

}  // namespace

std::vector<SensitiveState> simulate_sensitive(const MotionLaw& law, double x0_m, double v0_m_s,
                                               std::span<const double> times_s, const SolverOptions& options) {
  return SensitiveMotion(law, x0_m, v0_m_s, times_s, options).run();
}

}  // namespace glidelab::sim
