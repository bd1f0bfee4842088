#include "core/motion/free/motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/quantile.h"
#include "core/motion/smoothing/noise.h"

namespace glidelab::core {
namespace {

constexpr double kRounding = 1e-12;  // of the largest position: some thousand epsilon

}  // namespace

Motion motion_of(const TrackData& track, double mass_kg) {
  Motion motion{track.t_s, track.x_m, track.x_m, {}, median_step(track.t_s), 0.0, !track.force_n.empty()};
  motion.point.resize(track.t_s.size());
  std::iota(motion.point.begin(), motion.point.end(), std::size_t{0});
  if (motion.forced) {
    double v = 0.0, x = 0.0;  // of the force's own motion, from rest
    for (std::size_t i = 1; i < track.t_s.size(); ++i) {
      const double dt = track.t_s[i] - track.t_s[i - 1];
      const double before = track.force_n[i - 1] / mass_kg, after = track.force_n[i] / mass_kg;
      x += v * dt + dt * dt * (2.0 * before + after) / 6.0;
      v += 0.5 * dt * (before + after);
      motion.y_m[i] -= x;
    }
  }
  motion.noise_m = pilot_noise(motion.t_s, motion.y_m);
  // Not below what rounding makes of sums over a kernel: a constant must not look like a motion.
  for (const double y : motion.y_m) motion.noise_m = std::max(motion.noise_m, kRounding * std::abs(y));
  return motion;
}

Motion without(const Motion& motion, const std::vector<std::size_t>& points) {
  Motion rest;
  rest.step_s = motion.step_s;
  rest.noise_m = motion.noise_m;
  rest.forced = motion.forced;
  for (std::size_t i = 0; i < motion.t_s.size(); ++i) {
    if (std::binary_search(points.begin(), points.end(), i)) continue;
    rest.t_s.push_back(motion.t_s[i]);
    rest.x_m.push_back(motion.x_m[i]);
    rest.y_m.push_back(motion.y_m[i]);
    rest.point.push_back(motion.point[i]);
  }
  return rest;
}

}  // namespace glidelab::core
