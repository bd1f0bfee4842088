/// The laws of the effects that act in one motion, and what they come to together.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "diagnose/effects/effect.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {

/// An effect that acts in one motion, with its parameters.
struct Acting {
  const EffectLaw* law;
  const double* p;
};

class ActingEffects {
 public:
  void add(const EffectLaw& law, const double* p) { effects_[count_++] = {&law, p}; }
  std::span<const Acting> all() const { return {effects_.data(), count_}; }
  std::span<Acting> all() { return {effects_.data(), count_}; }
  bool any() const { return count_ > 0; }

 private:
  std::array<Acting, kEffects> effects_;
  std::size_t count_ = 0;
};

/// The laws of the effects that act. Each of their functions is called only if it changes something.
struct ActingLaws {
  ActingLaws(const EffectValues& values, const GliderConstants& glider);

  ActingEffects resistance, force, friction, seen, rates;
  double inertia_kg = 0.0;
  double known_factor = 1.0, known_late_s = 0.0;
  double stretch = 1.0;  ///< ratio of true to stated time
  double row_s = 0.0;
  bool steady = true;          ///< all forces are (EffectLaw::steady),
  bool steady_driving = true;  ///< or all but the friction
};

}  // namespace glidelab::diagnose
