/// A force law from its table in a scenario.
#pragma once

#include <memory>

#include "base/toml/strict_toml.h"
#include "sim/force/force_law.h"

namespace glidelab::sim {

/// Reads `law` and the keys of that law (law_list.h) from one [[configuration.force]]. A value given over the mass is
/// multiplied by `mass_kg`. Errors are recorded in the file; the term then holds NaN and must not be used before
/// finish().
std::shared_ptr<const ForceTerm> read_force(const base::TomlTable& table, double mass_kg);

}  // namespace glidelab::sim
