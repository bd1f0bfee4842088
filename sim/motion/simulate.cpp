#include "sim/motion/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/errors.h"
#include "sim/motion/cvodes_solver.h"

namespace glidelab::sim {

namespace {

// Where F0 = 0, the ratio of the force to |v|^p is taken no nearer to rest than this, so that it does not become 0 / 0.
constexpr double kSpeedOfRatio = 1e-150;  // m/s

}  // namespace

Slide::Slide(const Body& body, int direction, double least_speed_m_s)
    : body_(body),
      direction_(direction),
      least_speed_m_s_(least_speed_m_s),
      contact_(contact_of(body)),
      weight_n_(weight_along_track_n(body)) {
  for (const auto& term : body.forces) exponent_ = std::min(exponent_, term->exponent_at_rest());
  const double along = direction * net_force_n(body, 0.0, direction);
  if (along != 0.0) {
    stops_ = along < 0.0;
    return;
  }
  stops_ = exponent_ < 1.0;
  variable_ = stops_ ? Variable::power : Variable::logarithm;
}

double Slide::variable(double v_m_s) const {
  if (variable_ == Variable::speed) return v_m_s;
  const double speed = direction_ * v_m_s;
  return variable_ == Variable::power ? std::pow(speed, 1.0 - exponent_) : std::log(speed);
}

double Slide::speed_m_s(double variable) const {
  switch (variable_) {
    case Variable::power:
      return variable > 0.0 ? direction_ * std::pow(variable, 1.0 / (1.0 - exponent_)) : 0.0;
    case Variable::logarithm:
      return direction_ * std::exp(variable);
    case Variable::speed:
      break;
  }
  return variable;
}

Slide::Force Slide::force_at(double v_m_s) const {
  Force sum{0.0, 0.0};
  for (const auto& term : body_.forces) {
    if (variable_ == Variable::speed && std::abs(v_m_s) < least_speed_m_s_ && term->exponent_at_rest() < 1.0) {
      const double at_rest = term->force_n(0.0, direction_, contact_);
      const double at_least = term->force_n(direction_ * least_speed_m_s_, direction_, contact_);
      const double slope = (at_least - at_rest) / (direction_ * least_speed_m_s_);
      sum.n += at_rest + slope * v_m_s;
      sum.slope_n_s_m += slope;
    } else {
      sum.n += term->force_n(v_m_s, direction_, contact_);
      sum.slope_n_s_m += term->slope_n_s_m(v_m_s, direction_, contact_);
    }
  }
  return sum;
}

double Slide::acceleration_m_s2(double v_m_s) const {
  return (weight_n_ + force_at(v_m_s).n) / body_.mass_kg;
}

Eigen::Vector3d Slide::rate(const Eigen::Vector3d& y) const {
  const double v = speed_m_s(y[1]);
  const double dissipated = -force_at(v).n * v;
  if (variable_ == Variable::speed) return {v, acceleration_m_s2(v), dissipated};
  const double speed = std::max(std::abs(v), kSpeedOfRatio);
  const double a = direction_ * acceleration_m_s2(direction_ * speed);
  if (variable_ == Variable::logarithm) return {v, a / speed, dissipated};
  return {v, (1.0 - exponent_) * a / std::pow(speed, exponent_), dissipated};
}

Eigen::Matrix3d Slide::jacobian(const Eigen::Vector3d& y) const {
  const double v = speed_m_s(y[1]);
  // No nearer to rest than where rate() takes the ratio; there everything but the ratio is 0.
  const double u = variable_ == Variable::speed ? v : direction_ * std::max(std::abs(v), kSpeedOfRatio);
  const Force force = force_at(u);
  double rate_by_variable = force.slope_n_s_m / body_.mass_kg;
  double speed_by_variable = 1.0;
  if (variable_ != Variable::speed) {
    // w' = |v|' / |v|^p up to a factor, so dw'/dw = (F'(v) - p F / v) / m, with p = 1 for the logarithm.
    rate_by_variable -= exponent_ * (weight_n_ + force.n) / u / body_.mass_kg;
    speed_by_variable =
        variable_ == Variable::logarithm ? v : direction_ * std::pow(std::abs(v), exponent_) / (1.0 - exponent_);
  }
  Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
  jacobian(0, 1) = speed_by_variable;
  jacobian(1, 1) = rate_by_variable;
  jacobian(2, 1) = -(force.n + v * force.slope_n_s_m) * speed_by_variable;
  return jacobian;
}

OdeSystem Slide::system(double relative_tolerance, double absolute_tolerance) const {
  OdeSystem system;
  system.rate = [*this](const Eigen::Vector3d& y) { return rate(y); };
  system.jacobian = [*this](const Eigen::Vector3d& y) { return jacobian(y); };
  if (stops_) system.event = [](const Eigen::Vector3d& y) { return y[1]; };
  system.event_crossing = variable_ == Variable::speed ? -direction_ : -1;
  system.relative_tolerance = relative_tolerance;
  system.absolute_tolerance = absolute_tolerance * Eigen::Vector3d(1.0, 1.0, body_.mass_kg);
  return system;
}

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// In a shorter step nothing changes within a double's precision, and products in CVODES would underflow.
constexpr double kShortestStep = 1e-100;  // s
// Times the absolute tolerance: the speed below which a slope that is infinite at rest is made linear. At 1, Newton's
// method stalled in some of 10000 random motions; at 100, in none of 24000.
constexpr double kLeastSpeed = 100.0;

void require(bool good, const std::string& key, double found, const std::string& expected) {
  if (!good) throw base::InputError(base::Issue{"", 0, key, fmt::format("{}", found), expected});
}

void check(const Body& body, double x0_m, double v0_m_s, std::span<const double> times_s,
           const SolverOptions& options) {
  require(std::isfinite(body.mass_kg) && body.mass_kg > 0.0, "mass_kg", body.mass_kg, "a number above 0");
  require(std::isfinite(body.incline_rad), "incline_rad", body.incline_rad, "a finite number");
  require(std::isfinite(body.gravity_m_s2), "gravity_m_s2", body.gravity_m_s2, "a finite number");
  require(std::isfinite(x0_m), "x0_m", x0_m, "a finite number");
  require(std::isfinite(v0_m_s), "v0_m_s", v0_m_s, "a finite number");
  for (const double tolerance : {options.relative_tolerance, options.absolute_tolerance}) {
    require(std::isfinite(tolerance) && tolerance > 0.0, "tolerance", tolerance, "a number above 0");
  }
  double before = -1.0;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double t = times_s[i];
    const bool rises = std::isfinite(t) && t >= 0.0 && t > before;
    if (!rises) {  // composing the message for each of them would take as long as the simulation
      require(false, fmt::format("times_s[{}]", i), t,
              i == 0 ? "a time that is not negative" : fmt::format("a time later than {}", before));
    }
    before = t;
  }
}

Mode sliding(double sign) {
  return sign < 0.0 ? Mode::slide_up : Mode::slide_down;
}

// One motion, passing through its modes.
class Motion {
 public:
  Motion(const Body& body, double x0_m, double v0_m_s, std::span<const double> times_s, const SolverOptions& options)
      : body_(body),
        times_s_(times_s),
        options_(options),
        mode_(v0_m_s != 0.0 ? sliding(v0_m_s) : mode_at_rest(body)),
        start_(x0_m, v0_m_s, 0.0) {}

  Trajectory run() {
    while (!done()) {
      if (mode_ == Mode::stick) {
        stay();
      } else {
        slide();
      }
    }
    if (solver_) trajectory_.solver_steps = solver_->steps();
    return std::move(trajectory_);
  }

 private:
  bool done() const { return trajectory_.states.size() == times_s_.size(); }
  double next_s() const { return times_s_[trajectory_.states.size()]; }

  void record(double x_m, double v_m_s, double a_m_s2, double dissipated_j) {
    trajectory_.states.push_back({next_s(), x_m, v_m_s, a_m_s2, mode_});
    trajectory_.dissipated_j = dissipated_j;
  }

  // No force here depends on time, so a glider that sticks stays.
  void stay() {
    while (!done()) record(start_[0], 0.0, 0.0, start_[2]);
  }

  void come_to_rest(double t_s, double x_m, double dissipated_j) {
    const Mode before = mode_;
    mode_ = mode_at_rest(body_);
    if (mode_ == before) {
      throw base::NumericalError(
          fmt::format("at t = {} s the forces stop the glider and set it off again in the same direction: a term holds "
                      "less at rest "
                      "than it opposes to sliding",
                      t_s));
    }
    start_s_ = t_s;
    start_ = {x_m, 0.0, dissipated_j};
    trajectory_.changes.push_back({t_s, x_m, before, mode_});
  }

  // Slides until v = 0 or the last time.
  void slide() {
    const Slide slide(body_, static_cast<int>(mode_), kLeastSpeed * options_.absolute_tolerance);
    const double start_a = slide.acceleration_m_s2(start_[1]);
    if (slide.stops() && std::abs(start_[1]) <= kShortestStep * std::abs(start_a)) {
      come_to_rest(start_s_, start_[0], start_[2]);
      return;
    }
    // CVODES refuses a first step that vanishes in rounding.
    while (!done() && next_s() - start_s_ <= std::max(8.0 * kEpsilon * next_s(), kShortestStep)) {
      record(start_[0], start_[1], start_a, start_[2]);
    }
    if (done()) return;
    restart(slide);
    while (!done()) {
      const double t_s = next_s();
      const OdeState reached = solver_->advance(t_s);
      const double v = slide.speed_m_s(reached.y[1]);
      const double a = slide.acceleration_m_s2(v);
      // A root that rounding put slightly after the requested time counts as being at that time.
      const bool at_rest = slide.stops() && std::abs(v) <= 100.0 * kEpsilon * t_s * std::abs(a);
      if (reached.at_event || at_rest) {
        come_to_rest(reached.t_s, reached.y[0], reached.y[2]);
        return;
      }
      record(reached.y[0], v, a, reached.y[2]);
    }
  }

  void restart(const Slide& slide) {
    OdeSystem system = slide.system(options_.relative_tolerance, options_.absolute_tolerance);
    const Eigen::Vector3d y(start_[0], slide.variable(start_[1]), start_[2]);
    if (solver_) {
      solver_->restart(std::move(system), start_s_, y);
    } else {
      solver_.emplace(std::move(system), start_s_, y);
    }
  }

  const Body& body_;
  std::span<const double> times_s_;
  SolverOptions options_;
  Mode mode_;
  double start_s_ = 0.0;
  Eigen::Vector3d start_;  // x, v, dissipated energy where this mode began
  std::optional<CvodesSolver> solver_;
  Trajectory trajectory_;
};

}  // namespace

std::string_view name_of(Mode mode) {
  switch (mode) {
    case Mode::slide_up:
      return "slide_up";
    case Mode::slide_down:
      return "slide_down";
    case Mode::stick:
      break;
  }
  return "stick";
}

Mode mode_at_rest(const Body& body) {
  const double load = load_at_rest_n(body);
  // Equality up to rounding counts as held: mu = tan(alpha) is a legitimate input.
  if (std::abs(load) <= holding_n(body) * (1.0 + 8.0 * kEpsilon)) return Mode::stick;
  return sliding(load);
}

Trajectory simulate(const Body& body, double x0_m, double v0_m_s, std::span<const double> times_s,
                    const SolverOptions& options) {
  check(body, x0_m, v0_m_s, times_s, options);
  return Motion(body, x0_m, v0_m_s, times_s, options).run();
}

}  // namespace glidelab::sim
