/// The parts of an image in which something may stand out by a given contrast; the rest need not be searched.
#pragma once

#include <opencv2/core.hpp>

#include <vector>

namespace glidelab::core {

/// The rectangle with a border all around it.
inline cv::Rect with_border(const cv::Rect& rect, int border) {
  return {rect.x - border, rect.y - border, rect.width + 2 * border, rect.height + 2 * border};
}

/// Rectangles that hold every place of the region from which, within `sight_px` in both directions, there are pixels
/// that differ by `contrast`. A mean lies between the darkest and the brightest of its pixels: means of pixels within
/// sight differ by less at all other places. Values of 8 or 16 bits; parts may overlap.
std::vector<cv::Rect> parts_with_contrast(const cv::Mat& values, const cv::Rect& region, double contrast, int sight_px);

}  // namespace glidelab::core
