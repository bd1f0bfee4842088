#include "validate/blind/case/blind_effect.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidelab::validate {

double either_sign(BlindRandom& random) {
  return uniform(random, 0.0, 1.0) < 0.5 ? -1.0 : 1.0;
}

std::vector<double> phases(const BlindDesign& design, BlindRandom& random) {
  std::vector<double> phase;
  for (std::size_t c = 0; c < design.clips.size(); ++c) phase.push_back(uniform(random, 0.0, kTurn));
  return phase;
}

double wave_hz(const BlindDesign& design, BlindRandom& random) {
  const BlindClip& clip = design.clips.front();
  const double longest = static_cast<double>(clip.frames) / clip.rate_hz;
  return log_uniform(random, 3.0 / longest, std::min(0.35 * clip.rate_hz, 40.0));
}

}  // namespace glidelab::validate
