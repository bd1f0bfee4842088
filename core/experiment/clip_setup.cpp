#include "core/experiment/clip_setup.h"

#include <cmath>

namespace glidelab::core {
namespace {

constexpr double kContradiction = 5.0;  // standard deviations between two readings of one angle

}  // namespace

bool contradicts(const ClipSetup& one, const ClipSetup& other) {
  if (!one.incline_sd_rad || !other.incline_sd_rad) return false;
  const double apart = std::abs(one.incline_rad - other.incline_rad);
  return apart > kSameIncline_rad + kContradiction * std::hypot(*one.incline_sd_rad, *other.incline_sd_rad);
}

}  // namespace glidelab::core
