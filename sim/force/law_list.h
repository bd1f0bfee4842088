/// All force laws that a scenario can name.
///
/// To add one: its file in sim/force/laws, a line in the list below, its test, and its row in the table of the
/// scenario's documentation.
#pragma once

#include <memory>
#include <span>

#include "base/toml/strict_toml.h"
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

/// A force law from its table in a scenario.
///
/// Reads `law` and the keys of that law from one [[configuration.force]]. A value given over the mass is multiplied by
/// `mass_kg`. Errors are recorded in the file; the term then holds NaN and must not be used before finish().
std::shared_ptr<const ForceTerm> read_force(const base::TomlTable& table, double mass_kg);

}  // namespace glidelab::sim
