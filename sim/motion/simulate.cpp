#include "sim/motion/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/errors.h"
#include "sim/motion/cvodes_solver.h"
#include "sim/motion/slide.h"

namespace glidelab::sim {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Shorter than this, nothing changes that a double could show, and products in CVODES would underflow.
constexpr double kShortestStep = 1e-100;  // s
// Times the absolute tolerance: the speed below which a slope that is infinite at rest is straightened. At 1 Newton's
// method was seen to stall in some of 10000 random motions, at 100 in none of 24000.
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
    if (!rises) {  // to put the words together for each of them would take as long as to simulate
      require(false, fmt::format("times_s[{}]", i), t,
              i == 0 ? "a time that is not negative" : fmt::format("a time later than {}", before));
    }
    before = t;
  }
}

Mode sliding(double sign) {
  return sign < 0.0 ? Mode::slide_up : Mode::slide_down;
}

// One motion on its way through its modes.
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

  // No force here depends on time, so what sticks stays.
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

  // To v = 0, or to the last time.
  void slide() {
    const Slide slide(body_, static_cast<int>(mode_), kLeastSpeed * options_.absolute_tolerance);
    const double start_a = slide.acceleration_m_s2(start_[1]);
    if (slide.stops() && std::abs(start_[1]) <= kShortestStep * std::abs(start_a)) {
      come_to_rest(start_s_, start_[0], start_[2]);
      return;
    }
    // CVODES refuses a first step that is lost in rounding.
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
      // A root that rounding put a little behind the requested time is at that time.
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
  // Equal up to rounding counts as held: mu = tan(alpha) is a fair thing to write down.
  if (std::abs(load) <= holding_n(body) * (1.0 + 8.0 * kEpsilon)) return Mode::stick;
  return sliding(load);
}

Trajectory simulate(const Body& body, double x0_m, double v0_m_s, std::span<const double> times_s,
                    const SolverOptions& options) {
  check(body, x0_m, v0_m_s, times_s, options);
  return Motion(body, x0_m, v0_m_s, times_s, options).run();
}

}  // namespace glidelab::sim
