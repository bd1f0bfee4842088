/// The inner corners of a chessboard pattern in an image: found, put in the contract's order, and refined.
///
/// Order: X runs along the longer row of inner corners, from the side whose corner squares are black to the side whose
/// corner squares are white (both ends alike: to the right in the image), Y across it so that X, Y and the direction
/// away from the camera are right-handed. Corner (i, j) is points[j * columns + i], at pattern coordinates
/// (i, j) * square. Pixels; the centre of the first pixel is (0, 0).
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace glidelab::core {

struct BoardCorners {
  cv::Size grid;  ///< columns (the longer row), rows
  std::vector<cv::Point2d> points;
  std::vector<double> sd_px;  ///< of one coordinate, from the corner's own fit; 0 if it was not refined
  std::size_t unrefined = 0;  ///< corners whose fit did not converge; they keep the detector's position
  cv::Point2d at(int i, int j) const { return points[static_cast<std::size_t>(j * grid.width + i)]; }
};

enum class BoardDetector { any, classic, sector_based };  ///< findChessboardCorners, findChessboardCornersSB

/// Nothing if no whole board with this number of inner corners is found. `grey` has 8 or 16 bits. `inner_corners` as
/// OpenCV counts them; which of the two numbers comes first does not matter.
std::optional<BoardCorners> find_board(const cv::Mat& grey, cv::Size inner_corners,
                                       BoardDetector detector = BoardDetector::any);

/// The order above, for corners that run row by row from any corner of the board in any direction.
BoardCorners orient_board(const cv::Mat& grey, cv::Size inner_corners, const std::vector<cv::Point2f>& corners);

/// Refines each corner by a fit of two crossing edges (corner_fit.h). If the fit fails, the corner stays and is counted
/// in `unrefined`.
BoardCorners refine_board(const cv::Mat& grey, BoardCorners board);

}  // namespace glidelab::core
