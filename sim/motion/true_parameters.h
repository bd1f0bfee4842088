/// What an analysis is compared with: K/m and mu of a body, and its terminal velocity.
#pragma once

#include <optional>

#include "sim/force/force_law.h"

namespace glidelab::sim {

/// K/m and mu of a body whose forces are viscous and Coulomb terms and nothing else (several of one kind add up; none
/// of a kind is 0). mu is that of sliding.
struct LinearLaw {
  double k_over_m_1_s = 0.0;
  double mu = 0.0;
};
std::optional<LinearLaw> linear_law(const Body& body);

/// The speed v > 0 at which the net force vanishes and falls through zero, so that the glider settles to it: for
/// viscous and Coulomb friction (m g sin(alpha) - mu N) / K. Of several the lowest. Nothing where there is none up to
/// 1000 m/s, or where the force at v = 0 is 0 within rounding and falls. Found by bisection to the last bit between
/// neighbours of a logarithmic grid, 64 speeds a decade from 1 nm/s: two zeros closer than that are missed.
std::optional<double> limit_speed_m_s(const Body& body);

}  // namespace glidelab::sim
