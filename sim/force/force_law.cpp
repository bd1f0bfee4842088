#include "sim/force/force_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glidelab::sim {

std::shared_ptr<const ForceTerm> ForceLaw::with(std::initializer_list<double> given) const {
  std::vector<double> values(given);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ForceParameter& parameter = parameters[i];
    if (i == values.size() && !parameter.not_below.empty()) {
      const auto other = std::ranges::find(parameters, parameter.not_below, &ForceParameter::key);
      values.push_back(values[static_cast<std::size_t>(other - parameters.begin())]);
    }
    if (i < values.size() && !parameter.range.contains(values[i])) {
      throw std::logic_error(
          fmt::format("{}: {} = {} is not {}", id, parameter.key, values[i], parameter.range.describe()));
    }
  }
  if (values.size() != parameters.size()) {
    throw std::logic_error(fmt::format("{}: {} values for {} parameters", id, values.size(), parameters.size()));
  }
  return make(values);
}

Contact contact_of(const Body& body) {
  return {.mass_kg = body.mass_kg, .normal_n = body.mass_kg * body.gravity_m_s2 * std::cos(body.incline_rad)};
}

double weight_along_track_n(const Body& body) {
  return body.mass_kg * body.gravity_m_s2 * std::sin(body.incline_rad);
}

double net_force_n(const Body& body, double v_m_s, int direction) {
  const Contact contact = contact_of(body);
  double sum = weight_along_track_n(body);
  for (const auto& term : body.forces) sum += term->force_n(v_m_s, direction, contact);
  return sum;
}

double load_at_rest_n(const Body& body) {
  const Contact contact = contact_of(body);
  double sum = weight_along_track_n(body);
  for (const auto& term : body.forces) {
    if (term->holding_n(contact) == 0.0) sum += term->force_n(0.0, +1, contact);
  }
  return sum;
}

double holding_n(const Body& body) {
  const Contact contact = contact_of(body);
  double sum = 0.0;
  for (const auto& term : body.forces) sum += term->holding_n(contact);
  return sum;
}

}  // namespace glidelab::sim
