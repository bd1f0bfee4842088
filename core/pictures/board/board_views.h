/// The pictures of a calibration: in which of them the pattern is seen whole, and which of those a camera may rest on.
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include "core/pictures/board/chessboard.h"

namespace glidelab::core {

struct BoardView {
  std::filesystem::path file;
  BoardCorners corners;
};

/// What the pictures of the pattern gave.
struct BoardViews {
  std::vector<BoardView> views;                ///< in the order asked for, without those that failed
  std::vector<std::filesystem::path> without;  ///< pictures in which no whole board was seen
  cv::Size picture_size;
};

/// Finds the board in every file (each once, even if it is named twice), `jobs` at a time. InputError for a file that
/// is no picture or of another size than the first.
BoardViews find_board_views(const std::vector<std::filesystem::path>& files, cv::Size inner_corners, int jobs);

/// The views with a board; InputError that names the pictures without one where there are fewer than three.
std::vector<const BoardView*> checked_views(const BoardViews& boards);

/// Views that a camera may rest on, and what to say of those that are off.
struct KeptViews {
  std::vector<const BoardView*> views;
  std::vector<std::string> notes;
};

/// Without those whose error is above 0.2 px and five times the median's (one that is off pulls all parameters); all of
/// them where fewer than three would be left. A note of each that is off says which of the two.
KeptViews without_outliers(const std::vector<const BoardView*>& views, const std::vector<double>& errors_px);

/// Names of files without their folders, with commas between.
std::string names_of(const std::vector<std::filesystem::path>& files);

/// The pattern's corners at (i, j) * square, in the order of BoardCorners.
std::vector<cv::Point3d> pattern_points(cv::Size grid, double square_m);

}  // namespace glidelab::core
