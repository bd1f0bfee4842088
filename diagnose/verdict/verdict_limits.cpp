#include "diagnose/verdict/verdict_limits.h"

#include <algorithm>
#include <cmath>

#include "diagnose/gap/held_out.h"

namespace glidelab::diagnose {
namespace {

constexpr double kBelowZero = 5.0;    // standard deviations from which on a drag or friction counts as negative
constexpr double kContradicts = 5.0;  // standard deviations of a statement from everything else
constexpr double kLargePart = 0.2;    // of the motion: from here on a reader must know that it is set aside

std::vector<NegativeLoss> what_drives(const MotionFit& fit) {
  std::vector<NegativeLoss> found;
  const Eigen::MatrixXd covariance = common_covariance(fit);
  for (Eigen::Index g = 0; g < 2; ++g) {  // K, mu
    const double value = fit.at.global[g], sd = std::sqrt(std::max(0.0, covariance(g, g)));
    if (!(value < -kBelowZero * sd)) continue;
    found.push_back({g == 0 ? NegativeLoss::Of::drag : NegativeLoss::Of::friction, value, sd});
  }
  return found;
}

std::vector<ContradictedIncline> contradicted_statements(const TrackSet& set, const MotionFit& fit) {
  std::vector<ContradictedIncline> found;
  for (const StatementPull& pull : statement_pulls(set, fit)) {
    if (!pull.z || std::abs(*pull.z) < kContradicts) continue;
    found.push_back({pull.group, pull.against, pull.stated_rad, pull.stated_sd_rad, pull.else_rad, pull.else_sd_rad,
                     !fit.effects.empty(), std::abs(*pull.z)});
  }
  return found;
}

/// Positions that no explanation answers for: those that look like a hand or a stop, or lie far off.
std::optional<SetAside> set_aside(const TrackSet& set) {
  double points = 0.0, outliers = 0.0;
  for (const TrackedMotion& motion : set.motions) {
    points += static_cast<double>(motion.t_s.size());
    outliers +=
        static_cast<double>(std::count_if(motion.outlier.begin(), motion.outlier.end(), [](char o) { return o != 0; }));
  }
  const auto moving = static_cast<double>(set.moving), left_out = static_cast<double>(set.left_out);
  if (!(moving > 0.0 && points > 0.0)) return {};
  const double part = (left_out + (moving - left_out) * outliers / points) / moving;
  if (part < kLargePart) return {};
  return SetAside{set.moving, part};
}

}  // namespace

VerdictLimits limits_of(const TrackSet& set, const MotionFit& fit) {
  return {what_drives(fit), contradicted_statements(set, fit), set_aside(set)};
}

}  // namespace glidelab::diagnose
