#include "sim/force/read_force.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "sim/force/force_terms.h"

namespace glidelab::sim {

namespace {

using base::TomlTable;

// K of -K v: as it is, or over the mass; exactly one of the two.
double read_k(const TomlTable& table, double mass_kg) {
  const bool absolute = table.has("k_n_s_m");
  const bool over_mass = table.has("k_over_m_1_s");
  if (absolute && over_mass) {
    table.reject("k_over_m_1_s", "both k_n_s_m and k_over_m_1_s", "exactly one of the two");
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (over_mass) return mass_kg * table.number("k_over_m_1_s", base::at_least(0.0));
  if (absolute) return table.number("k_n_s_m", base::at_least(0.0));
  table.reject("k_n_s_m", "nothing", "exactly one of k_n_s_m and k_over_m_1_s, a number of at least 0");
  return std::numeric_limits<double>::quiet_NaN();
}

std::shared_ptr<const ForceTerm> read_coulomb(const TomlTable& table) {
  const double mu = table.number("mu", base::between(0.0, 10.0));
  const double mu_static = table.number_or("mu_static", mu, base::between(0.0, 10.0));
  if (mu_static < mu) {
    table.reject("mu_static", fmt::format("{}", mu_static), fmt::format("a number not less than mu = {}", mu));
  }
  return std::make_shared<CoulombForce>(mu, mu_static);
}

// What is no law says nothing of its keys, so none of them is called unknown.
std::shared_ptr<const ForceTerm> no_law(const TomlTable& table) {
  for (const char* key :
       {"k_n_s_m", "k_over_m_1_s", "mu", "mu_static", "c_kg_m", "n", "s", "v_s_m_s", "v_c_m_s", "force_n"}) {
    table.has(key);
  }
  return std::make_shared<ConstantForce>(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

std::shared_ptr<const ForceTerm> read_force(const TomlTable& table, double mass_kg) {
  using base::above;
  using base::at_least;
  using base::between;
  const std::optional<std::string> law =
      table.one_of("law", {"viscous", "coulomb", "quadratic", "power_law", "stribeck", "eddy_rolloff", "constant"});
  if (!law) return no_law(table);
  if (law == "viscous") return std::make_shared<ViscousForce>(read_k(table, mass_kg));
  if (law == "coulomb") return read_coulomb(table);
  if (law == "quadratic") return std::make_shared<QuadraticForce>(table.number("c_kg_m", at_least(0.0)));
  if (law == "power_law") {
    return std::make_shared<PowerLawForce>(table.number("k_n_s_m", at_least(0.0)),
                                           table.number("n", between(0.1, 5.0)));
  }
  if (law == "stribeck") {
    return std::make_shared<StribeckForce>(table.number("mu", between(0.0, 10.0)),
                                           table.number("s", between(1.0, 100.0)), table.number("v_s_m_s", above(0.0)));
  }
  if (law == "eddy_rolloff") {
    return std::make_shared<EddyRolloffForce>(read_k(table, mass_kg), table.number("v_c_m_s", above(0.0)));
  }
  return std::make_shared<ConstantForce>(table.number("force_n"));
}

}  // namespace glidelab::sim
