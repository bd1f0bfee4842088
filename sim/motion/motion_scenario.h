/// The motions of a scenario: which gliders, under which forces, launched how, and the true K/m, mu and terminal
/// velocity, with which an analysis is compared. render/ models what the camera sees of them.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/toml/strict_toml.h"
#include "sim/force/force_law.h"

namespace glidelab::sim {

/// K/m and mu of a body whose forces are viscous and Coulomb terms and nothing else (several of one kind add up; none
/// of a kind is 0). mu is the sliding coefficient.
struct LinearLaw {
  double k_over_m_1_s = 0.0;
  double mu = 0.0;
};
std::optional<LinearLaw> linear_law(const Body& body);

/// The speed v > 0 at which the net force vanishes and falls through zero, so that the glider settles to it: for
/// viscous and Coulomb friction (m g sin(alpha) - mu N) / K. If there are several, the lowest. Empty if there is none
/// up to 1000 m/s, or if the force at v = 0 is 0 within rounding and falls. Found by bisection to the last bit between
/// neighbours of a logarithmic grid with 64 speeds per decade from 1 nm/s: two zeros closer than that are missed.
std::optional<double> limit_speed_m_s(const Body& body);

enum class Launched { up, down, released };

/// One recorded motion: starts at t = 0 with (x0, v0), x positive downhill from the track's reference point.
struct MotionSetup {
  std::string name;
  Launched launched = Launched::released;
  double x0_m = 0.0;
  double v0_m_s = 0.0;
  double duration_s = 0.0;
};

/// One glider on one inclination, with the motions recorded of it.
struct ConfigurationSetup {
  std::string name;
  Body body;                        ///< the truth: mass, true inclination, gravity, forces
  double stated_incline_rad = 0.0;  ///< what the experimenter writes down
  double stated_incline_sd_rad = 0.0;
  std::string group;  ///< clips that share one set-up of the track
  std::vector<MotionSetup> motions;
};

struct MotionScenario {
  std::string name;
  double gravity_m_s2 = 9.80665;
  std::vector<ConfigurationSetup> configurations;
};

/// Reads `format`, `name`, `gravity_m_s2` and [[configuration]] with its [[configuration.force]] and
/// [[configuration.clip]] (docs/reference/scenario.md). Errors are recorded in the file and thrown by its finish(); the
/// caller reads its own tables and then calls finish().
MotionScenario read_motions(const base::TomlTable& root);

}  // namespace glidelab::sim
