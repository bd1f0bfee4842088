/// Single positions that lie off the motion: a marker that was mistaken for something else in one frame.
#pragma once

#include <cstddef>
#include <vector>

#include "core/motion/free/motion.h"

namespace glidelab::core {

/// Indices of points that lie off the cubic through their ten nearest neighbours by more than six standard deviations
/// of that prediction: of the noise, or of what the neighbours themselves scatter about the cubic, whichever is more.
/// At a release or a jump the neighbours scatter as much as the point, and into an impact's own point the motion before
/// or after it runs smoothly (the parabola of five neighbours on one side, within three standard deviations): nothing
/// there is an outlier. Up to two of the neighbours may be outliers themselves. For normal noise one point in 1e9 is
/// taken by mistake.
std::vector<std::size_t> find_outliers(const Motion& motion);

}  // namespace glidelab::core
