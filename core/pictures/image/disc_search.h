/// The search for discs in an image: made smaller, confined to parts with contrast, disc against surroundings.
#pragma once

#include <opencv2/core.hpp>

#include <vector>

#include "base/math/simd.h"

namespace glidelab::core {

/// An image made smaller: each pixel of the small one is the mean over its rectangle of the large one, in which a pixel
/// that is cut counts by its part. What cv::INTER_AREA does, to the rounding of single precision. `values` of 8 or 16
/// bits; `size` is not empty and no larger than theirs (asserted). Single precision.
cv::Mat area_means(const cv::Mat& values, cv::Size size, base::Simd simd = base::Simd::best);

/// The rectangle with a border all around it.
inline cv::Rect with_border(const cv::Rect& rect, int border) {
  return {rect.x - border, rect.y - border, rect.width + 2 * border, rect.height + 2 * border};
}

/// The parts of an image in which something may stand out by a given contrast; the rest need not be searched.
/// Rectangles that hold every place of the region from which, within `sight_px` in both directions, there are pixels
/// that differ by `contrast`. A mean lies between the darkest and the brightest of its pixels: means of pixels within
/// sight differ by less at all other places. Values of 8 or 16 bits; parts may overlap.
std::vector<cv::Rect> parts_with_contrast(const cv::Mat& values, const cv::Rect& region, double contrast, int sight_px);

/// The squares with which a disc is searched for: one inside it, and eight around it.
struct DiscSquares {
  int inner = 0;  ///< half the side of the one within, less half a pixel
  int outer = 0;  ///< of those around
  int away = 0;   ///< from the disc's centre to those next to it

  explicit DiscSquares(double radius_px);
};

inline constexpr int kMostBrightNeighbours = 3;

/// The contrast of a disc of given radius with its surroundings, at each position of an image. The mean of the inner
/// square less the brightest but `bright_neighbours` (0 to 3) of the means of the squares around it, each over its part
/// within the image; 0 where it is not above, where more of them are outside, and outside the region. `values` and the
/// result are of single precision.
cv::Mat disc_response(const cv::Mat& values, const cv::Rect& region, const DiscSquares& squares, int bright_neighbours,
                      base::Simd simd = base::Simd::best);

}  // namespace glidelab::core
