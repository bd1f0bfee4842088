/// All force laws that a scenario can name.
///
/// To add one: its file in sim/force/laws, a line in the list below, its test, and its row in the table of the
/// scenario's documentation.
#pragma once

#include <span>

#include "sim/force/force_law.h"

/// The ids, in the order in which messages and documentation name them; sim/force/laws/ID_law.cpp (power_law.cpp)
/// defines laws::ID().
#define GLIDELAB_FORCE_LAWS(LAW) \
  LAW(viscous)                   \
  LAW(coulomb)                   \
  LAW(quadratic)                 \
  LAW(power_law)                 \
  LAW(stribeck)                  \
  LAW(eddy_rolloff)              \
  LAW(constant)

namespace glidelab::sim {

namespace laws {
#define GLIDELAB_DECLARE_LAW(id) const ForceLaw& id();
GLIDELAB_FORCE_LAWS(GLIDELAB_DECLARE_LAW)
#undef GLIDELAB_DECLARE_LAW
}  // namespace laws

std::span<const ForceLaw* const> force_laws();

}  // namespace glidelab::sim
