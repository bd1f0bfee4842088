#include "diagnose/effects/effect_twin.h"

#include <fmt/format.h>

#include <algorithm>

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

}  // namespace glidelab::diagnose
