#include "diagnose/weigh/unknown_noise.h"

#include <algorithm>
#include <cmath>

namespace glidelab::diagnose {
namespace {

constexpr double kDegreesOfPosition = 0.38;  // 2/(4 * 1.32)
constexpr double kLeastDegreesKnown = 30.0;  // of freedom, from which on the noise counts as known

}  // namespace

std::optional<FewPositions> few_positions(const TrackSet& set) {
  FewPositions few;
  for (const TrackedMotion& motion : set.motions) {
    few.positions += static_cast<double>(std::count(motion.outlier.begin(), motion.outlier.end(), char{0}));
  }
  few.degrees = kDegreesOfPosition * few.positions;
  return few.degrees < kLeastDegreesKnown ? std::optional(few) : std::nullopt;
}

double gain_with_unknown_noise(const FewPositions& of, double chi2, double gain) {
  const double after = std::max(0.0, chi2 - 2.0 * gain);
  return 0.5 * (of.degrees + of.positions) * std::log((of.degrees + chi2) / (of.degrees + after));
}

double lost_to_unknown_noise(const std::optional<FewPositions>& of, double chi2, double gain) {
  return of && gain > 0.0 ? gain - gain_with_unknown_noise(*of, chi2, gain) : 0.0;
}

}  // namespace glidelab::diagnose
