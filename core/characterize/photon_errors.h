/// Errors common to all tiles of the images, which the jackknife over tiles cannot see: the drift of the dark level
/// from frame to frame and from set to set, and what rounding to whole codes hides.
#pragma once

#include "core/characterize/photon_numbers.h"

namespace glidelab::core {

struct SharedErrors {
  double offset_dn = 0.0;  ///< standard deviations
  double dark_slope_dn_s = 0.0;
  double gain_variance = 0.0;
  double intercept_variance = 0.0;
};
SharedErrors shared_errors(const Evidence& evidence, const PhotonNumbers& numbers);

/// Variance over the pixels and frames of a cell without the rounding's.
inline double spread_dn2(const FlatFieldStack& stack) {
  return stack.all.total_dn2 - kQuantisation;
}

}  // namespace glidelab::core
