#include "diagnose/effects/effect_values.h"

#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {

EffectValues::EffectValues() {
  static const auto absent = [] {
    std::array<std::array<double, kMostParameters>, kEffects> values{};
    for (const EffectInfo& effect : all_effects()) {
      for (const EffectParameter& parameter : effect.parameters) {
        values[parameter.slot.effect][parameter.slot.parameter] = parameter.absent;
      }
    }
    return values;
  }();
  values_ = absent;
}

}  // namespace glidelab::diagnose
