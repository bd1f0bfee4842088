#include "diagnose/effects/effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glidelab::diagnose {

void TwinForces::replace_drag(std::string_view id, std::string text) {
  if (!drag.empty()) lacks.push_back({drag_by, "a drag law cannot contain another one"});
  drag = std::move(text);
  drag_by = id;
}

std::string scenario_force(const std::string& law, const std::map<std::string, double>& keys) {
  std::string text = fmt::format("[[configuration.force]]\nlaw = \"{}\"\n", law);
  for (const auto& [key, value] : keys) text += fmt::format("{} = {:.12g}\n", key, value);
  return text;
}

std::optional<double> TwinSizes::of(std::string_view key) const {
  const auto found = std::find_if(sizes_.begin(), sizes_.end(), [&](const auto& size) { return size.first == key; });
  if (found == sizes_.end()) return {};
  return found->second;
}

ShownValue shown(const EffectParameter& parameter, double fitted) {
  if (parameter.shown_as == ShownAs::inverse_root)
    return {1.0 / std::sqrt(fitted), -0.5 / (fitted * std::sqrt(fitted))};
  if (parameter.shown_as == ShownAs::one_more) return {1.0 + fitted, 1.0};
  return {fitted, 1.0};
}

std::vector<double> places_of(const ShapeReach& reach, int parts) {
  std::vector<double> places;
  for (int i = 0; i < parts; ++i) {
    places.push_back(reach.x_low_m + (reach.x_high_m - reach.x_low_m) * (i + 0.5) / parts);
  }
  return places;
}

}  // namespace glidelab::diagnose
