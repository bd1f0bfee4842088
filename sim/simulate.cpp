#include "sim/simulate.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>

#include "base/errors.h"
#include "sim/cvodes_solver.h"
#include "sim/slide.h"

namespace glidelab::sim {

namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

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
    require(std::isfinite(t) && t >= 0.0 && t > before, fmt::format("times_s[{}]", i), t,
            i == 0 ? "a time that is not negative" : fmt::format("a time later than {}", before));
    before = t;
  }
}

Mode sliding(double sign) {
  return sign < 0.0 ? Mode::slide_up : Mode::slide_down;
}

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
  Trajectory trajectory;
  Mode mode = v0_m_s != 0.0 ? sliding(v0_m_s) : mode_at_rest(body);
  double start_s = 0.0;
  Eigen::Vector3d start(x0_m, v0_m_s, 0.0);  // x, v, dissipated
  std::optional<CvodesSolver> solver;

  std::size_t next = 0;
  while (next < times_s.size()) {
    if (mode == Mode::stick) {  // no force here depends on time, so it stays
      for (; next < times_s.size(); ++next) {
        trajectory.states.push_back({times_s[next], start[0], 0.0, 0.0, Mode::stick});
      }
      trajectory.dissipated_j = start[2];
      break;
    }
    const Slide slide(body, static_cast<int>(mode));
    OdeSystem system = slide.system(options.relative_tolerance, options.absolute_tolerance);
    const Eigen::Vector3d y0(start[0], slide.variable(start[1]), start[2]);
    if (solver) {
      solver->restart(std::move(system), start_s, y0);
    } else {
      solver.emplace(std::move(system), start_s, y0);
    }
    const Mode sliding_mode = mode;
    while (next < times_s.size() && mode == sliding_mode) {
      const double t = times_s[next];
      // CVODES refuses a first step that is lost in the rounding of t; the state has not changed then.
      if (t - start_s <= 8.0 * kEpsilon * t) {
        trajectory.states.push_back({t, start[0], start[1], slide.acceleration_m_s2(start[1]), mode});
        trajectory.dissipated_j = start[2];
        ++next;
        continue;
      }
      const OdeState reached = solver->advance(t);
      if (reached.at_event) {
        start_s = reached.t_s;
        start = {reached.y[0], 0.0, reached.y[2]};
        mode = mode_at_rest(body);
        if (mode == sliding_mode) {
          throw base::NumericalError(fmt::format(
              "at t = {} s the forces stop the glider and set it off again in the same direction: a term holds less at "
              "rest than it opposes to sliding",
              start_s));
        }
        trajectory.changes.push_back({start_s, start[0], sliding_mode, mode});
      } else {
        const double v = slide.speed_m_s(reached.y[1]);
        trajectory.states.push_back({t, reached.y[0], v, slide.acceleration_m_s2(v), mode});
        trajectory.dissipated_j = reached.y[2];
        ++next;
      }
    }
  }
  if (solver) trajectory.solver_steps = solver->steps();
  return trajectory;
}

}  // namespace glidelab::sim
