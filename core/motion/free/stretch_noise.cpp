#include "core/motion/free/stretch_noise.h"

#include <algorithm>
#include <cmath>

#include "core/motion/free/speed_dependent_noise.h"

namespace glidelab::core {
namespace {

/// The stretches with their smoothers.
struct SmoothedStretches {
  std::vector<LocalCubic> cubics;
  std::vector<NoisePiece> pieces;
  SmoothedStretches(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
    cubics.reserve(stretches.size());
    for (const FreeStretch& stretch : stretches) {
      cubics.emplace_back(std::span(motion.t_s).subspan(stretch.first, stretch.count), bandwidth_s);
      pieces.push_back({&cubics.back(), std::span(motion.y_m).subspan(stretch.first, stretch.count)});
    }
  }
};

}  // namespace

PositionNoise noise_at(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
  return estimate_noise(SmoothedStretches(motion, stretches, bandwidth_s).pieces, motion.noise_m);
}

std::vector<double> noise_factors(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
  if (motion.forced) return {};  // y' is not the speed
  const auto of_stretches = speed_factors(SmoothedStretches(motion, stretches, bandwidth_s).pieces);
  if (of_stretches.empty()) return {};
  std::vector<double> factors(motion.t_s.size(), 1.0);
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    std::copy(of_stretches[s].begin(), of_stretches[s].end(),
              factors.begin() + static_cast<std::ptrdiff_t>(stretches[s].first));
  }
  return factors;
}

std::optional<double> coarse_rounding(const Motion& motion, const PositionNoise& noise) {
  const double step = rounding_step(motion.x_m);
  if (!(step > 0.0) || noise.sd_m > 1.5 * step / std::sqrt(12.0)) return std::nullopt;
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < motion.x_m.size(); ++i) {
    repeated += std::abs(motion.x_m[i] - motion.x_m[i - 1]) < 0.5 * step;
  }
  return 5 * repeated > motion.x_m.size() ? std::optional(step) : std::nullopt;
}

}  // namespace glidelab::core
