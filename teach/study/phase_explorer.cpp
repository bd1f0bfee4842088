#include "teach/study/phase_explorer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

#include "sim/force/law_list.h"
#include "sim/motion/simulate.h"

namespace glidelab::teach {
namespace {

constexpr double kStep = 0.1;      // of tau, in units of the time in which u changes by its own size
constexpr double kFirst = 1e-4;    // the shortest step of tau towards u = 0
constexpr double kNear = 0.25;     // of the remaining time to it
constexpr double kSettled = 1e-9;  // of the limit's value
constexpr double kLeg = 0.1;       // of u: its fall within one leg
constexpr int kDrawn = 72;
constexpr std::uint64_t kSeedOfDrawn = 20260101;  // any: the drawn settings are the same on every page
constexpr int kReferencePoints = 6;

void add_drag(sim::Body& body, double k, double n) {
  if (n == 0.0 || k == 0.0) return;
  if (n == 1.0) {
    body.forces.push_back(sim::laws::viscous().with({k * body.mass_kg}));
  } else if (n == 2.0) {
    body.forces.push_back(sim::laws::quadratic().with({k * body.mass_kg}));
  } else {
    body.forces.push_back(sim::laws::power_law().with({k * body.mass_kg, n}));
  }
}

/// A body of unit mass with unit gravity on a vertical track: the drive is +1, -1 or zero.
sim::Body unit_body(double drive, double n) {
  sim::Body body;
  body.mass_kg = 1.0;
  body.gravity_m_s2 = 1.0;
  body.incline_rad = drive * 0.5 * std::numbers::pi;
  add_drag(body, 1.0, n);
  return body;
}

/// Times up to `end` at which the orbit from u0 is stored: steps of a tenth of the time in which u changes by its own
/// size (that of a drag u^n alone, or 1 if less). If n is not an integer, u^n has no Taylor series at u = 0: near
/// `rest`, the instant at which u = 0, the steps are shorter.
std::vector<double> times(double drive, double n, double u0, double end, std::optional<double> rest) {
  std::vector<double> tau = {0.0};
  while (tau.back() < end) {
    double own = n > 1.0 ? std::pow(u0, 1.0 - n) + (n - 1.0) * tau.back() : 1.0;
    if (drive != 0.0) own = std::min(own, 1.0);
    double step = n == 0.0 ? 1.0 : kStep * own;  // without drag everything is a parabola
    if (rest && n != std::round(n)) step = std::min(step, std::max(kFirst, kNear * std::abs(*rest - tau.back())));
    tau.push_back(std::min(end, tau.back() + step));
  }
  return tau;
}

/// The orbit until it comes to rest, if it does. Every leg starts again at a distance of 0, and the distances are added
/// up from the end, so that small ones keep their digits next to large ones.
Orbit solved(double drive, double n, double u0, const std::vector<double>& tau) {
  const sim::Body body = unit_body(drive, n);
  const auto point = [&](double at, double u, double distance, double slope) {
    return OrbitPoint{at, u, distance, slope, n == 0.0 ? 0.0 : -n * std::pow(u, n - 1.0) * slope};
  };
  Orbit orbit = {point(0.0, u0, 0.0, sim::net_force_n(body, u0, 1))};
  bool moves = true;
  for (std::size_t from = 0; moves && from + 1 < tau.size(); from = orbit.size() - 1) {
    std::vector<double> leg;
    for (std::size_t i = from; i < tau.size(); ++i) leg.push_back(tau[i] - tau[from]);
    const sim::Trajectory motion = sim::simulate(body, 0.0, orbit.back().u, leg);
    const double enough = orbit.back().u > 1.0 ? kLeg * orbit.back().u : 0.0;
    double distance = 0.0;
    for (std::size_t i = 1; moves && i < leg.size() && (i == 1 || orbit.back().u > enough); ++i) {
      if (!motion.changes.empty() && leg[i] >= motion.changes.front().t_s) {
        orbit.push_back(
            point(tau[from] + motion.changes.front().t_s, 0.0, motion.changes.front().x_m - distance, drive));
        moves = false;
        continue;
      }
      const sim::State& state = motion.states[i];
      orbit.push_back(point(tau[from + i], state.v_m_s, state.x_m - distance, state.a_m_s2));
      distance = state.x_m;
    }
  }
  double after = 0.0;
  for (auto now = orbit.rbegin(); now != orbit.rend(); ++now) {
    const double step = std::exchange(now->distance, -after);
    after += step;
  }
  return orbit;
}

/// The orbit from u0, for `end` or until it comes to rest.
Orbit orbit(double drive, double n, double u0, double end) {
  std::optional<double> rest;
  if (u0 == 0.0) rest = 0.0;
  if (drive < 0.0) rest = solved(drive, n, u0, times(drive, n, u0, end, std::nullopt)).back().tau;
  return solved(drive, n, u0, times(drive, n, u0, end, rest));
}

LawOrbits orbits_of(std::string name, double n) {
  LawOrbits law{std::move(name), n, {}, {}, {}, {}};
  if (n == 0.0) {
    law.rising = orbit(1.0, n, 0.0, kLongest);
    law.braking = orbit(-1.0, n, kLongest, 2.0 * kLongest);
    law.free = orbit(0.0, n, 1.0, kLongest);
    return law;
  }
  // Near the limit, u - 1 falls as exp(-n tau).
  const double settling = -std::log(kSettled) / n;
  const double from_afar = n > 1.0 ? 2.0 / (n - 1.0) : std::log(kFastest);
  law.rising = orbit(1.0, n, 0.0, settling);
  law.falling = orbit(1.0, n, kFastest, from_afar + settling);
  law.braking = orbit(-1.0, n, kFastest, from_afar + 5.0);
  law.free = orbit(0.0, n, 1.0, kLongest);
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
  if (mu > 0.0) body.forces.push_back(sim::laws::coulomb().with({mu}));
  for (int i = 1; i <= kReferencePoints; ++i) motion.t_s.push_back(kExplorerTime * i / kReferencePoints);
  for (const sim::State& state : sim::simulate(body, 0.0, v0_m_s, motion.t_s).states) {
    motion.x_m.push_back(state.x_m);
    motion.v_m_s.push_back(state.v_m_s);
    motion.a_m_s2.push_back(state.a_m_s2);
  }
  return motion;
}

/// Every slider at both ends, and the level track and the start at rest.
void add_corners(PhaseExplorer& explorer) {
  for (std::size_t law = 0; law < explorer.laws.size(); ++law) {
    for (const double drag : {kDragRange.low, kDragRange.high}) {
      if (explorer.laws[law].exponent == 0.0 && drag != kDragRange.low) continue;  // it has no drag
      for (const double mu : {kMuRange.low, kMuRange.high}) {
        for (const double alpha_deg : {kInclineRange.low, 0.0, kInclineRange.high}) {
          for (const double v0_m_s : {kStartRange.low, 0.0, kStartRange.high}) {
            explorer.references.push_back(reference(explorer, law, drag, mu, alpha_deg, v0_m_s));
          }
        }
      }
    }
  }
}

void add_drawn(PhaseExplorer& explorer) {
  std::mt19937_64 random(kSeedOfDrawn);
  const auto draw = [&](const ExplorerRange& range) {
    return range.low + (range.high - range.low) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < kDrawn; ++i) {
    const std::size_t law = static_cast<std::size_t>(i) % explorer.laws.size();
    const double drag = std::exp(draw({std::log(kDragRange.low), std::log(kDragRange.high)}));
    const double mu = draw(kMuRange), alpha_deg = draw(kInclineRange), v0_m_s = draw(kStartRange);
    explorer.references.push_back(reference(explorer, law, drag, mu, alpha_deg, v0_m_s));
  }
}

}  // namespace

PhaseExplorer explore_phases() {
  PhaseExplorer explorer;
  explorer.laws = {orbits_of("viscous", 1.0), orbits_of("power-3/2", 1.5), orbits_of("quadratic", 2.0),
                   orbits_of("none", 0.0)};
  add_corners(explorer);
  add_drawn(explorer);
  return explorer;
}

}  // namespace glidelab::teach
