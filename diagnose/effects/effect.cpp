#include "diagnose/effects/effect.h"

#include <cmath>

namespace glidelab::diagnose {

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
