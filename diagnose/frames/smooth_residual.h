/// What remains of each motion's residuals after a smooth curve: the scatter of single positions, regardless of any
/// force that the model lacks.
///
/// The curve is a least-squares sum of Gaussian bumps, as fine as it must be until neighbours no longer err alike: what
/// the law lacks by hundreds of deviations shows a coarse one's own error, first of all at the clip's ends.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// Of all points of a motion, outliers too.
struct Leftover {
  std::vector<double> over_sd;  ///< each over its own noise, and over what so many bumps take up of white noise
  std::vector<double> v_m_s;    ///< modelled
};

Leftover leftover_of(const TrackSet& set, const MotionFit& fit, std::size_t motion);

}  // namespace glidelab::diagnose
