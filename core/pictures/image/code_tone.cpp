#include "core/pictures/image/code_tone.h"

#include <algorithm>
#include <cmath>

namespace glidelab::core {

double light_of_code(ToneCurve tone, double code) {
  const double share = std::clamp(code, 0.0, 1.0);
  if (tone == ToneCurve::linear) return share;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

double code_of_light(ToneCurve tone, double light) {
  const double share = std::clamp(light, 0.0, 1.0);
  if (tone == ToneCurve::linear) return share;
  return share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1.0 / 2.4) - 0.055;
}

}  // namespace glidelab::core
