#include "sim/sensitivity/sensitivity.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "base/errors.h"
#include "sim/oracle/closed_forms.h"

namespace glidelab::sim {

LawValue TrackLaw::sliding(double, double v_m_s, int direction) const {
  LawValue value;
  value.a_m_s2 = drive_m_s2_ - k_1_s_ * v_m_s - direction * friction_m_s2_;
  value.by_v_1_s = -k_1_s_;
  value.by_parameter.resize(3);
  value.by_parameter << -v_m_s, 1.0, -direction;
  return value;
}

BodyLaw::BodyLaw(Body body) : body_(std::move(body)), contact_(contact_of(body_)) {
  for (const auto& term : body_.forces) parameters_ += static_cast<int>(term->by_parameter(1.0, +1, contact_).size());
}

LawValue BodyLaw::sliding(double, double v_m_s, int direction) const {
  LawValue value;
  value.a_m_s2 = net_force_n(body_, v_m_s, direction) / body_.mass_kg;
  value.by_parameter.resize(parameters_);
  int next = 0;
  for (const auto& term : body_.forces) {
    value.by_v_1_s += term->slope_n_s_m(v_m_s, direction, contact_) / body_.mass_kg;
    for (const double by : term->by_parameter(v_m_s, direction, contact_)) {
      value.by_parameter[next++] = by / body_.mass_kg;
    }
  }
  return value;
}

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

  /// Slides until v = 0 or the last time.
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

namespace {

constexpr Eigen::Index kParameters = 5;  // k, d, f, x0, v0
using Derivatives = Eigen::Matrix<double, 2, kParameters>;

/// e, phi and psi after the time t, and their derivatives by k.
struct Flow {
  double e, phi, psi, phi_k, psi_k;

  Flow(double k, double t) {
    const double z = -k * t, one = phi1(z), two = phi2(z);
    e = std::exp(z);
    phi = t * one;
    psi = t * t * two;
    phi_k = -t * t * (one - two);                // phi1' = phi1 - phi2
    psi_k = -t * t * t * (two - 2.0 * phi3(z));  // phi2' = phi2 - 2 phi3
  }
};

struct Phase {
  double start_s, x_m, v_m_s;
  int direction;  // 0: it sticks
  Derivatives by;
};

struct Law {
  double k, drive, friction;

  double net(int direction) const { return drive - direction * friction; }
  int direction_at_rest() const { return std::abs(drive) <= friction ? 0 : drive > 0.0 ? 1 : -1; }
};

SensitiveState state_at(const Law& law, const Phase& phase, double t_s) {
  SensitiveState state;
  state.t_s = t_s;
  state.mode = static_cast<Mode>(phase.direction);
  if (phase.direction == 0) {
    state.x_m = phase.x_m;
    state.by_parameter = phase.by;
    state.by_parameter.row(1).setZero();
    return state;
  }
  const Flow flow(law.k, t_s - phase.start_s);
  const double a0 = law.net(phase.direction);
  state.x_m = phase.x_m + phase.v_m_s * flow.phi + a0 * flow.psi;
  state.v_m_s = phase.v_m_s * flow.e + a0 * flow.phi;
  Derivatives by;
  by.row(0) = phase.by.row(0) + flow.phi * phase.by.row(1);
  by.row(1) = flow.e * phase.by.row(1);
  by(0, 0) += phase.v_m_s * flow.phi_k + a0 * flow.psi_k;
  by(1, 0) += -(t_s - phase.start_s) * flow.e * phase.v_m_s + a0 * flow.phi_k;
  by(0, 1) += flow.psi;
  by(1, 1) += flow.phi;
  by(0, 2) -= phase.direction * flow.psi;
  by(1, 2) -= phase.direction * flow.phi;
  state.by_parameter = by;
  return state;
}

/// When the phase comes to v = 0, and what follows.
std::optional<Phase> next_phase(const Law& law, const Phase& phase) {
  if (phase.direction == 0) return std::nullopt;
  const double before = law.net(phase.direction);
  if (phase.v_m_s == 0.0) return std::nullopt;  // it has just set off and is gathering speed
  const auto stop_s = linear_stop_time_s(before, law.k, phase.v_m_s);
  if (!stop_s) return std::nullopt;
  const SensitiveState rest = state_at(law, phase, phase.start_s + *stop_s);
  Phase next{rest.t_s, rest.x_m, 0.0, law.direction_at_rest(), rest.by_parameter};
  const double after = next.direction == 0 ? 0.0 : law.net(next.direction);
  next.by.row(1) *= after / before;
  return next;
}

}  // namespace

std::vector<SensitiveState> track_motion_sensitive(double k_1_s, double drive_m_s2, double friction_m_s2, double x0_m,
                                                   double v0_m_s, std::span<const double> times_s) {
  const Law law{k_1_s, drive_m_s2, friction_m_s2};
  if (!std::isfinite(k_1_s + drive_m_s2 + friction_m_s2 + x0_m + v0_m_s)) {
    throw base::NumericalError(
        fmt::format("a motion with K/m = {} 1/s, drive {} m/s², friction {} m/s², from x0 = {} m, v0 = {} m/s", k_1_s,
                    drive_m_s2, friction_m_s2, x0_m, v0_m_s));
  }
  Phase phase{0.0, x0_m, v0_m_s, v0_m_s > 0.0 ? 1 : v0_m_s < 0.0 ? -1 : law.direction_at_rest(), Derivatives::Zero()};
  phase.by(0, 3) = 1.0;
  phase.by(1, 4) = 1.0;
  std::optional<Phase> next = next_phase(law, phase);
  std::vector<SensitiveState> states;
  states.reserve(times_s.size());
  for (const double t_s : times_s) {
    if (next && t_s >= next->start_s) {
      phase = *next;
      next.reset();  // from rest it gathers speed: v = 0 comes once
    }
    states.push_back(state_at(law, phase, t_s));
    if (!std::isfinite(states.back().x_m)) {
      throw base::NumericalError(fmt::format("a motion with K/m = {} 1/s runs away by t = {} s", k_1_s, t_s));
    }
  }
  return states;
}

}  // namespace glidelab::sim
