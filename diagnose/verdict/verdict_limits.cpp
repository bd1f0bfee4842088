#include "diagnose/verdict/verdict_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text/size_text.h"
#include "diagnose/gap/held_out.h"

namespace glidelab::diagnose {
namespace {

constexpr double kBelowZero = 5.0;      // standard deviations
constexpr double kContradiction = 5.0;  // standard deviations of a statement from everything else
constexpr double kLargePart = 0.2;      // of the motion

std::vector<std::string> what_drives(const MotionFit& fit) {
  std::vector<std::string> words;
  const Eigen::MatrixXd covariance = common_covariance(fit);
  for (Eigen::Index g = 0; g < 2; ++g) {  // K, mu
    const double value = fit.at.global[g], sd = std::sqrt(std::max(0.0, covariance(g, g)));
    if (!(value < -kBelowZero * sd)) continue;
    words.push_back(
        fmt::format("The fit has a {} below zero ({}), which would drive the glider: what is missing "
                    "takes it there, or what is stated of the inclination, of downhill or of the masses is wrong.",
                    g == 0 ? "drag" : "friction", base::size_and_sd_text(value, sd, g == 0 ? "N s/m" : "")));
  }
  return words;
}

/// To the first digit of a standard deviation, two at least.
int decimals(double sd) {
  return sd > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(sd))), 2, 9) : 2;
}

std::vector<std::string> contradicted_statements(const TrackSet& set, const MotionFit& fit) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::vector<std::string> words;
  for (const StatementPull& pull : statement_pulls(set, fit)) {
    if (!pull.z || std::abs(*pull.z) < kContradiction) continue;
    words.push_back(fmt::format(
        "The inclination of set-up \"{}\" is {:.2f} ± {:.2g}° as {}, and the motion says {:.{}f} ± {:.1g}° by the {} "
        "({:.3g} standard deviations apart).",
        pull.group, kDegrees * pull.stated_rad, kDegrees * pull.stated_sd_rad,
        pull.against == "plumb" ? "the plumb line has it" : pull.against, kDegrees * pull.else_rad,
        decimals(kDegrees * pull.else_sd_rad), kDegrees * pull.else_sd_rad,
        fit.effects.empty() ? "usual model" : "model with what is named", std::abs(*pull.z)));
  }
  return words;
}

/// Positions that no explanation answers for: hand or stop by their looks, or far off.
std::string set_aside(const TrackSet& set) {
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
  return fmt::format(
      "Of the {} positions of the motion {:.0f} % are set aside: they look like a hand or a stop, or lie far off, and "
      "no effect of the "
      "list explains them. What is said holds for the others.",
      set.moving, 100.0 * part);
}

}  // namespace

VerdictLimits limits_of(const TrackSet& set, const MotionFit& fit) {
  return {what_drives(fit), contradicted_statements(set, fit), set_aside(set)};
}

}  // namespace glidelab::diagnose
