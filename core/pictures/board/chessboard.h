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
#include "core/pictures/board/corner_fit.h"
#include "core/pictures/image/edge_response.h"

namespace glidelab::core {

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

/// The part of an image that holds a board, with the corners as they were found. It begins at an even column and row,
/// so that its pixels keep their places in a mosaic.
struct BoardImage {
  cv::Mat part;
  cv::Point first;     ///< the part's first pixel in the image
  BoardCorners board;  ///< in the part
};

BoardImage cut_board(const cv::Mat& grey, BoardCorners board);

/// The response to an edge of the pixels of the camera that took these images, from corners of all of them. If a board
/// lies along the rows, it shows each edge at few sub-pixel positions, where a response and a displacement of the
/// corners look alike; tilted boards show all.
std::optional<EdgeResponse> board_response(const std::vector<BoardImage>& images);

/// Refines each corner with fit_corner(); in the whole image. If the fit fails, the corner stays and is counted in
/// `unrefined`. An image that the response does not suit (turned, or from another camera) is fitted with its own.
BoardCorners refine_board(const BoardImage& image, const std::optional<EdgeResponse>& response);
/// The same with the response that this image alone shows.
BoardCorners refine_board(const cv::Mat& grey, const BoardCorners& board);

}  // namespace glidelab::core
