#include "diagnose/verdict/verdict_notes.h"

#include <algorithm>

#include "diagnose/effects/effect_library.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

std::optional<BuoyancyLooksAlike> buoyancy_like(const TrackSet& set, const Diagnosis& diagnosis) {
  constexpr double kLeastRatio = 0.01, kLeastBesideAir = 0.5;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    if (effect.id == ids::rotational_inertia && !effect.parameters.empty()) {
      const double of_mass = effect.parameters.front().value / lightest_kg(set), ratio = of_mass / (1.0 + of_mass);
      const bool of_air = std::any_of(diagnosis.effects.begin(), diagnosis.effects.end(),
                                      [](const auto& other) { return other.id == ids::quadratic_drag; });
      if (ratio > (of_air ? kLeastBesideAir : kLeastRatio)) return BuoyancyLooksAlike{ratio, true};
    }
    const bool of_rate = effect.id == ids::frame_rate_error;
    if (!of_rate && effect.id != ids::scale_error) continue;
    for (const DiagnosedParameter& parameter : effect.parameters) {
      const double factor = (1.0 + parameter.value) * (of_rate ? 1.0 + parameter.value : 1.0);
      if (parameter.key == "e" && factor < 1.0 - kLeastRatio) return BuoyancyLooksAlike{1.0 - factor};
    }
  }
  return {};
}

std::vector<std::string> named_of_camera(const Diagnosis& diagnosis) {
  std::vector<std::string> named;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    if (effect_list()[effect_index(effect.id)].of_camera) named.push_back(effect.id);
  }
  return named;
}

void add_clear_scatter(const Comparison& comparison, Diagnosis& diagnosis) {
  constexpr double kCertain = 20.0;  // log evidence
  for (const FrameEffect& frame : comparison.frames) {
    const std::string id(effect_list()[frame.effect].id);
    const bool named = std::any_of(diagnosis.effects.begin(), diagnosis.effects.end(),
                                   [&](const DiagnosedEffect& effect) { return effect.id == id; });
    const bool known = std::find(diagnosis.traces.begin(), diagnosis.traces.end(), id) != diagnosis.traces.end();
    if (frame.log_evidence > kCertain && !named && !known) diagnosis.traces.push_back(id);
  }
}

}  // namespace glidelab::diagnose
