#include "sim/sensitivity/track_sensitivity.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/errors.h"
#include "sim/oracle/closed_forms.h"

namespace glidelab::sim {
namespace {

constexpr Eigen::Index kParameters = 5;  // k, d, f, x0, v0
using Derivatives = Eigen::Matrix<double, 2, kParameters>;

/// (e^z - 1 - z - z²/2) / z³, 1/6 at z = 0. Below |z| = 0.5 by its series, whose 15th term is below 1e-17.
double phi3(double z) {
  if (std::abs(z) >= 0.5) return (phi2(z) - 0.5) / z;
  double term = 1.0 / 6.0, sum = term;
  for (int n = 4; n < 18; ++n) {
    term *= z / n;
    sum += term;
  }
  return sum;
}

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
  if (phase.v_m_s == 0.0) return std::nullopt;  // it has just set off, and gathers speed
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
