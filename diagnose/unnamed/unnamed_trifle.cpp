#include "diagnose/unnamed/unnamed_trifle.h"

#include <cmath>
#include <cstddef>

#include "diagnose/gap/held_out.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {
namespace {

constexpr double kMostGain = 0.08;  // log likelihood a position: half the square of four tenths of its noise

}  // namespace

bool is_trifle(const TrackSet& set, const MotionFit& nominal, const std::vector<UnnamedFamily>& families) {
  using Kind = ParameterLayout::Global::Kind;
  const UnnamedFamily *shared = likeliest_shared(families), *of_clips = likeliest_of_clips(families);
  if (shared == nullptr && of_clips == nullptr) return false;
  const Eigen::MatrixXd covariance = common_covariance(nominal);
  const auto& globals = nominal.layout->globals();
  for (const UnnamedFamily* family : {shared, of_clips}) {
    if (family == nullptr) continue;
    if (family->gain > kMostGain * static_cast<double>(points_of(set))) return false;
    const MotionFit with = with_unnamed(set, nominal, *family);
    for (std::size_t g = 0; g < globals.size(); ++g) {
      if (globals[g].kind != Kind::k && globals[g].kind != Kind::mu && globals[g].kind != Kind::alpha) continue;
      const auto at = static_cast<Eigen::Index>(g);
      const double moved = std::abs(with.at.global[at] - nominal.at.global[at]);
      if (!(moved <= std::sqrt(covariance(at, at)))) return false;
    }
  }
  return true;
}

}  // namespace glidelab::diagnose
