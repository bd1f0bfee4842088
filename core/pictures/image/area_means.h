/// An image made smaller: each pixel of the small one is the mean over its rectangle of the large one, in which a
/// pixel that is cut counts by its part. What cv::INTER_AREA does, to the rounding of single precision.
#pragma once

#include <opencv2/core.hpp>

#include "base/math/simd.h"

namespace glidelab::core {

/// `values` of 8 or 16 bits; `size` is not empty and no larger than theirs (asserted). Single precision.
cv::Mat area_means(const cv::Mat& values, cv::Size size, base::Simd simd = base::Simd::best);

}  // namespace glidelab::core
