#include "diagnose/pictures/noise_law.h"

#include <cmath>

namespace glidelab::diagnose {

std::optional<NoiseLaw> noise_law(const std::vector<core::NoiseAtLevel>& levels) {
  if (levels.size() < 3) return std::nullopt;
  double w = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const core::NoiseAtLevel& one : levels) {
    const double sd = 2.0 * one.sd_code * one.known_to;  // of the variance
    if (!(sd > 0.0)) return std::nullopt;
    const double weight = 1.0 / (sd * sd), level = one.level_code, variance = one.sd_code * one.sd_code;
    w += weight;
    x += weight * level;
    y += weight * variance;
    xx += weight * level * level;
    xy += weight * level * variance;
  }
  const double determinant = w * xx - x * x;
  if (!(determinant > 1e-9 * w * xx)) return std::nullopt;
  NoiseLaw law{(w * xy - x * y) / determinant, std::sqrt(w / determinant), (xx * y - x * xy) / determinant};
  if (law.gain_code < 0.0) {
    law.gain_code = 0.0;
    law.dark_code2 = y / w;
  } else if (law.dark_code2 < 0.0) {
    law.dark_code2 = 0.0;
    law.gain_code = xy / xx;
  }
  return law;
}

}  // namespace glidelab::diagnose
