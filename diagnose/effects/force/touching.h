/// Prior odds of a force that needs something which touches the body: friction, a bumper, a cable.
#pragma once

#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {

/// A falling body touches nothing unless something guides it, and in free fall through air nothing guides it.
inline double touched(const Circumstances& of) {
  if (of.through_air) return 0.05;
  return of.only_falls ? 0.25 : 1.0;
}

}  // namespace glidelab::diagnose::effects
