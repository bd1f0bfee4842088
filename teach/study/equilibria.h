/// Where a glider's a(v) passes through zero, and whether it comes back from there when it is pushed.
///
/// a(v) = (m g sin(alpha) + forces(v, sign v)) / m. Where it falls through zero the equilibrium is stable, where it
/// rises unstable. v = 0 is one where static friction holds the glider, or where a(0) = 0.
#pragma once

#include <vector>

#include "sim/force/force_law.h"

namespace glidelab::teach {

struct Equilibrium {
  double v_m_s = 0.0;
  bool stable = true;
  bool stops = false;  ///< v = 0 is reached in a finite time: friction stops the glider. Else it is only tended to
};

/// Those from `lowest_m_s` to `highest_m_s`, rising; none where a is nothing on a whole interval. Of each sign of v
/// they are found by bisection to the last bit between neighbours of a logarithmic grid, 256 speeds a decade from 1e-9
/// m/s on: zeros closer than that, and those that a(v) only touches, are missed.
std::vector<Equilibrium> equilibria(const sim::Body& body, double lowest_m_s, double highest_m_s);

}  // namespace glidelab::teach
