#include "diagnose/causes/unnamed_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/tracks/whitening.h"
#include "diagnose/unnamed/unnamed.h"

namespace glidelab::diagnose {
namespace {

constexpr double kCostOfTakingTheBest = 3.0;  // ln 20: the likeliest of some twenty functions without a name is taken

/// The columns of a family in units of the noise alone: undoes the part of the whitening that the remainder caused.
RemainderExtra extra_of(const TrackSet& with, const UnnamedFamily& family) {
  RemainderExtra extra{family.columns, family.tau};
  Eigen::Index row = 0;
  for (const TrackedMotion& motion : with.motions) {
    const auto n = static_cast<Eigen::Index>(motion.t_s.size());
    extra.columns.middleRows(row, n) = without_remainder(motion, extra.columns.middleRows(row, n));
    row += n;
  }
  if (!std::isfinite(extra.sd)) {  // one bump of fixed size
    double largest = 0.0;
    for (const double size : family.size) largest = std::max(largest, std::abs(size));
    extra.sd = largest;
  }
  return extra;
}

}  // namespace

std::optional<double> unnamed_profile(const TrackSet& set, const TrackSet& with, const Profile& nominal,
                                      const MotionFit& noise_alone, const std::vector<UnnamedFamily>& families,
                                      const RemainderSizes& start) {
  std::optional<double> log;
  for (const UnnamedFamily* family : {likeliest_shared(families), likeliest_of_clips(families)}) {
    if (family == nullptr || !(family->tau > 0.0)) continue;
    const RemainderExtra extra = extra_of(with, *family);
    if (!(extra.sd > 0.0) || !extra.columns.allFinite()) continue;
    Profile profile = profile_of(set, noise_alone, &start, &extra);
    allow_for_unknown_noise(set, nominal, profile);
    log = std::max(log.value_or(-std::numeric_limits<double>::infinity()), profile.log_evidence - kCostOfTakingTheBest);
  }
  return log;
}

}  // namespace glidelab::diagnose
