/// The contrast of a disc of given radius with its surroundings, at each position of an image.
#pragma once

#include <opencv2/core.hpp>

#include "base/math/simd.h"

namespace glidelab::core {

/// The squares with which a disc is searched for: one inside it, and eight around it.
struct DiscSquares {
  int inner = 0;  ///< half the side of the one within, less half a pixel
  int outer = 0;  ///< of those around
  int away = 0;   ///< from the disc's centre to those beside it

  explicit DiscSquares(double radius_px);
};

inline constexpr int kMostBrightNeighbours = 3;

/// The mean of the inner square less the brightest but `bright_neighbours` (0 to 3) of the means of the squares around
/// it, of what of them lies in the image; 0 where it is not above, where more of them are outside, and outside the
/// region. `values` and the result are of single precision.
cv::Mat disc_response(const cv::Mat& values, const cv::Rect& region, const DiscSquares& squares, int bright_neighbours,
                      base::Simd simd = base::Simd::best);

}  // namespace glidelab::core
