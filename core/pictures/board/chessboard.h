/// The inner corners of a chessboard in an image: found, put in the contract's order, and each fitted to a hundredth of
/// a pixel.
///
/// Order: X runs along the longer row of inner corners, from the side whose corner squares are black to the side whose
/// corner squares are white (both ends alike: to the right in the image), Y across it so that X, Y and the direction
/// away from the camera are right-handed. Corner (i, j) is points[j * columns + i], at pattern coordinates (i, j) *
/// square. Pixels; the centre of the first pixel is (0, 0).
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/pictures/board/board_search.h"

namespace glidelab::core {

/// What is known of a corner before the fit.
struct CornerSurroundings {
  double window_px = 0.0;  ///< radius of the pixels used, short of the nearest edge of another corner
  double angle_x = 0.0;    ///< directions of its two edges, radians from u towards v
  double angle_y = 0.0;
};

struct FittedCorner {
  cv::Point2d point;
  double sd_px = 0.0;  ///< of one coordinate, from the fit's residuals
};

/// One corner of a chessboard, by a least-squares fit of two crossing edges to the pixels around it.
///
///     I(p) = (1 + h . d) (b + a (2 E1 - 1) (2 E2 - 1)),   d = p - c,   Ei = pixel_edge(ni . d, ni, s)
///
/// with the corner c, the edges' normals n1, n2, the lens's blur s, and the light's slope h. The pixel's square is
/// averaged over exactly for each edge alone (core/pictures/image/pixel_signal.h), so that a sharp image does not pull
/// the corner towards certain phases of the pixels; where both edges cross one pixel it is exact to second order for
/// right angles. A blur of another shape keeps the image point-symmetric about c and so does not move it.
///
/// `grey` has 8 or 16 bits. Nothing if the window is smaller than 2.5 px, or the fit does not converge, moves by half
/// the window or 3 px, or leaves residuals of a quarter of the contrast.
std::optional<FittedCorner> fit_corner(const cv::Mat& grey, cv::Point2d start, const CornerSurroundings& around);

struct BoardCorners {
  cv::Size grid;  ///< columns (the longer row), rows
  std::vector<cv::Point2d> points;
  std::vector<double> sd_px;  ///< of one coordinate, from the corner's own fit; 0 if it was not refined
  std::size_t unrefined = 0;  ///< corners whose fit did not converge; they keep the detector's position
  cv::Point2d at(int i, int j) const { return points[static_cast<std::size_t>(j * grid.width + i)]; }
};

/// Nothing if no whole board with this number of inner corners is found. `grey` has 8 or 16 bits. `inner_corners` as
/// OpenCV counts them; which of the two numbers comes first does not matter. `between` is called between the steps of
/// the search (board_search.h).
std::optional<BoardCorners> find_board(const cv::Mat& grey, cv::Size inner_corners,
                                       BoardDetector detector = BoardDetector::any,
                                       const std::function<void()>& between = {});

/// The order at the head of this file, for corners that run row by row from any corner of the board in any direction.
BoardCorners orient_board(const cv::Mat& grey, cv::Size inner_corners, const std::vector<cv::Point2f>& corners);

/// Refines each corner with fit_corner(). If the fit fails, the corner stays and is counted in `unrefined`.
BoardCorners refine_board(const cv::Mat& grey, BoardCorners board);

}  // namespace glidelab::core
