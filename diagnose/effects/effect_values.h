/// The sizes of all effects at once, as one motion feels them.
#pragma once

#include <array>
#include <cstddef>

#include "diagnose/effects/effect_list.h"

namespace glidelab::diagnose {

class EffectValues {
 public:
  /// All absent.
  EffectValues();

  double& operator[](const EffectSlot& slot) { return values_[slot.effect][slot.parameter]; }
  double operator[](const EffectSlot& slot) const { return values_[slot.effect][slot.parameter]; }

  /// An effect's parameters in order.
  const double* of(std::size_t effect) const { return values_[effect].data(); }

 private:
  std::array<std::array<double, kMostParameters>, kEffects> values_;
};

}  // namespace glidelab::diagnose
