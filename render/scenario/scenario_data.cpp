#include "render/scenario/scenario_data.h"

#include <cmath>
#include <numbers>

namespace glidelab::render {

double flicker_at(const Light& light, double t_s) {
  return 1.0 +
         light.flicker_depth * std::cos(2.0 * std::numbers::pi * light.flicker_hz * t_s + light.flicker_phase_rad);
}

double mean_flicker(const Light& light, double start_s, double exposure_s) {
  const double half_turn = std::numbers::pi * light.flicker_hz * exposure_s;
  const double sinc = half_turn < 1e-8 ? 1.0 : std::sin(half_turn) / half_turn;
  return 1.0 + sinc * (flicker_at(light, start_s + 0.5 * exposure_s) - 1.0);
}

}  // namespace glidelab::render
