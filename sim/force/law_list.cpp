#include "sim/force/law_list.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace glidelab::sim {

std::span<const ForceLaw* const> force_laws() {
#define GLIDELAB_LIST_LAW(id) &laws::id(),
  static const std::array all = {GLIDELAB_FORCE_LAWS(GLIDELAB_LIST_LAW)};
#undef GLIDELAB_LIST_LAW
  return all;
}

namespace {

using base::TomlTable;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

// A value as it is, or divided by the mass; exactly one of the two.
double read_either(const TomlTable& table, const ForceParameter& parameter, double mass_kg) {
  const bool absolute = table.has(parameter.key);
  const bool over_mass = table.has(parameter.over_mass);
  if (absolute && over_mass) {
    table.reject(parameter.over_mass, fmt::format("both {} and {}", parameter.key, parameter.over_mass),
                 "exactly one of the two");
    return kNothing;
  }
  if (over_mass) return mass_kg * table.number(parameter.over_mass, parameter.range);
  if (absolute) return table.number(parameter.key, parameter.range);
  table.reject(
      parameter.key, "nothing",
      fmt::format("exactly one of {} and {}, {}", parameter.key, parameter.over_mass, parameter.range.describe()));
  return kNothing;
}

double read_not_below(const TomlTable& table, const ForceParameter& parameter, double least) {
  const double value = table.number_or(parameter.key, least, parameter.range);
  if (value < least) {
    table.reject(parameter.key, fmt::format("{}", value),
                 fmt::format("a number not less than {} = {}", parameter.not_below, least));
  }
  return value;
}

// Without a law the allowed keys are not known, so none is called unknown.
std::shared_ptr<const ForceTerm> no_law(const TomlTable& table) {
  for (const ForceLaw* law : force_laws()) {
    for (const ForceParameter& parameter : law->parameters) {
      table.has(parameter.key);
      if (!parameter.over_mass.empty()) table.has(parameter.over_mass);
    }
  }
  const ForceLaw& any = *force_laws().front();
  return any.make(std::vector<double>(any.parameters.size(), kNothing));
}

}  // namespace

std::shared_ptr<const ForceTerm> read_force(const TomlTable& table, double mass_kg) {
  std::vector<std::string> ids;
  for (const ForceLaw* law : force_laws()) ids.push_back(law->id);
  const std::optional<std::string> id = table.one_of("law", ids);
  if (!id) return no_law(table);
  const ForceLaw& law = **std::ranges::find(force_laws(), *id, &ForceLaw::id);
  std::vector<double> values;
  for (const ForceParameter& parameter : law.parameters) {
    if (!parameter.over_mass.empty()) {
      values.push_back(read_either(table, parameter, mass_kg));
    } else if (!parameter.not_below.empty()) {
      const auto other = std::ranges::find(law.parameters, parameter.not_below, &ForceParameter::key);
      values.push_back(
          read_not_below(table, parameter, values[static_cast<std::size_t>(other - law.parameters.begin())]));
    } else {
      values.push_back(table.number(parameter.key, parameter.range));
    }
  }
  return law.make(values);
}

}  // namespace glidelab::sim
