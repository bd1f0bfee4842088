#include "validate/phase_explorer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "sim/force_terms.h"
#include "sim/simulate.h"

namespace glidelab::validate {
namespace {

constexpr double kStep = 0.1;      // of tau, in units of the time in which u changes by itself
constexpr double kSettled = 1e-9;  // of the limit's value
constexpr double kLongest = 1e3;   // tau of the free orbit: 10 s at k = 25, w = 2, n = 2
constexpr int kReferences = 72;
constexpr double kReferenceTime = 5.0;  // s
constexpr int kReferencePoints = 21;

void add_drag(sim::Body& body, double k, double n) {
  if (n == 0.0 || k == 0.0) return;
  if (n == 1.0) {
    body.forces.push_back(std::make_shared<sim::ViscousForce>(k * body.mass_kg));
  } else if (n == 2.0) {
    body.forces.push_back(std::make_shared<sim::QuadraticForce>(k * body.mass_kg));
  } else {
    body.forces.push_back(std::make_shared<sim::PowerLawForce>(k * body.mass_kg, n));
  }
}

/// A body of unit mass with unit gravity on a wall: the drive is +1, -1 or nothing.
sim::Body unit_body(double drive, double n) {
  sim::Body body;
  body.mass_kg = 1.0;
  body.gravity_m_s2 = 1.0;
  body.incline_rad = drive * 0.5 * std::numbers::pi;
  add_drag(body, 1.0, n);
  return body;
}

/// Times at which the orbit from u0 is kept: steps of a tenth of the time in which a drag u^n alone changes u, at most
/// `longest`.
std::vector<double> times(double u0, double n, double end, double longest) {
  std::vector<double> tau = {0.0};
  while (tau.back() < end) {
    const double own = n > 1.0 ? std::pow(u0, 1.0 - n) + (n - 1.0) * tau.back() : 1.0;
    tau.push_back(std::min(end, tau.back() + kStep * std::min(own, longest)));
  }
  return tau;
}

/// Up to where it comes to rest, if it does.
Orbit orbit(double drive, double n, double u0, const std::vector<double>& tau) {
  const sim::Trajectory solved = sim::simulate(unit_body(drive, n), 0.0, u0, tau);
  Orbit kept;
  const double stop = solved.changes.empty() ? tau.back() + 1.0 : solved.changes.front().t_s;
  for (std::size_t i = 0; i < tau.size() && tau[i] < stop; ++i) {
    const sim::State& state = solved.states[i];
    kept.push_back({tau[i], state.v_m_s, state.x_m, state.a_m_s2});
  }
  if (!solved.changes.empty()) kept.push_back({stop, 0.0, solved.changes.front().x_m, drive});
  const double end = kept.back().way;
  for (OrbitPoint& point : kept) point.way -= end;
  return kept;
}

LawOrbits orbits_of(std::string name, double n) {
  LawOrbits law{std::move(name), n, {}, {}, {}, {}};
  if (n == 0.0) {
    law.rising = orbit(1.0, n, 0.0, {0.0, kLongest});
    law.braking = orbit(-1.0, n, kLongest, {0.0, 2.0 * kLongest});
    law.free = orbit(0.0, n, 1.0, {0.0, kLongest});
    return law;
  }
  // Near the limit u - 1 falls as exp(-n tau).
  const double settling = -std::log(kSettled) / n;
  const double from_afar = n > 1.0 ? 2.0 / (n - 1.0) : std::log(kFastest);
  law.rising = orbit(1.0, n, 0.0, times(0.0, n, settling, 1.0));
  law.falling = orbit(1.0, n, kFastest, times(kFastest, n, from_afar + settling, 1.0));
  law.braking = orbit(-1.0, n, kFastest, times(kFastest, n, from_afar + 5.0, 1.0));
  law.free = orbit(0.0, n, 1.0, times(1.0, n, n > 1.0 ? kLongest : 40.0, kLongest));
  return law;
}

ReferenceMotion reference(const PhaseExplorer& explorer, std::size_t law, double drag, double mu, double alpha_deg,
                          double v0_m_s) {
  ReferenceMotion motion{law, drag, mu, alpha_deg, v0_m_s, {}, {}, {}, {}};
  sim::Body body;
  body.mass_kg = 1.0;
  body.gravity_m_s2 = explorer.gravity_m_s2;
  body.incline_rad = alpha_deg * std::numbers::pi / 180.0;
  add_drag(body, drag, explorer.laws[law].exponent);
  if (mu > 0.0) body.forces.push_back(std::make_shared<sim::CoulombForce>(mu));
  for (int i = 0; i < kReferencePoints; ++i) motion.t_s.push_back(kReferenceTime * i / (kReferencePoints - 1));
  for (const sim::State& state : sim::simulate(body, 0.0, v0_m_s, motion.t_s).states) {
    motion.x_m.push_back(state.x_m);
    motion.v_m_s.push_back(state.v_m_s);
    motion.a_m_s2.push_back(state.a_m_s2);
  }
  return motion;
}

}  // namespace

PhaseExplorer explore_phases() {
  PhaseExplorer explorer;
  explorer.laws = {orbits_of("viscous", 1.0), orbits_of("power-3/2", 1.5), orbits_of("quadratic", 2.0),
                   orbits_of("none", 0.0)};
  std::mt19937_64 random(20260101);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < kReferences; ++i) {
    const std::size_t law = static_cast<std::size_t>(i) % explorer.laws.size();
    const double k = draw(0.02, 5.0), mu = draw(0.0, 0.03), alpha_deg = draw(-4.0, 8.0), v0_m_s = draw(-2.0, 2.0);
    // Every so often what a slider at its end gives: no friction, a level track, a start at rest.
    const int special = (i / static_cast<int>(explorer.laws.size())) % 6;
    explorer.references.push_back(
        reference(explorer, law, special == 4 ? 0.0 : k, special == 1 || special == 5 ? 0.0 : mu,
                  special == 2 || special == 5 ? 0.0 : alpha_deg, special == 3 ? 0.0 : v0_m_s));
  }
  return explorer;
}

}  // namespace glidelab::validate
