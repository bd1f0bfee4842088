/// Where the corners of a chessboard may be in an image: OpenCV's detectors, with a bound on the work for any image.
///
/// findChessboardCorners compares all four-sided outlines with each other, so that its time grows with the square of
/// their number and more: an image of noise, of tiles or of a printed page keeps it busy for hours. A board has at most
/// a few hundred. Outlines are counted first, in black-and-white versions of the image as the detector makes them, and
/// a version with more than a thousand is not looked through. An image in which any version has more (a noisy image of
/// a board has them in its flat parts) is looked through version by version, without those. The image is first
/// looked at with 512 pixels a side (or a quarter of its own), which shows a board of large squares; else it is
/// searched at up to 1600 pixels a side, then at up to 4096.
#pragma once

#include <opencv2/core.hpp>

#include <functional>
#include <vector>

namespace glidelab::core {

enum class BoardDetector { any, classic, sector_based };  ///< findChessboardCorners, findChessboardCornersSB

/// Corners to about a pixel, row by row in OpenCV's order, in pixels of `grey` (8 or 16 bits); empty if no whole board
/// is found. `between`, if given, is called between the steps and may throw to end the search.
std::vector<cv::Point2f> search_board(const cv::Mat& grey, cv::Size inner_corners, BoardDetector detector,
                                      const std::function<void()>& between = {});

/// Four-sided outlines of dark spots on white, of 25 pixels or more: what findChessboardCorners compares. `white` has 8
/// bits, 0 or 255.
std::size_t count_quads(const cv::Mat& white);

}  // namespace glidelab::core
