/// The images of a calibration: which of them show the whole pattern, and which of those are good enough to calibrate
/// with.
#pragma once

#include <opencv2/core.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/experiment/permissions.h"
#include "core/pictures/board/chessboard.h"
#include "core/result/analysis_note.h"

namespace glidelab::core {

struct BoardView {
  std::filesystem::path file;
  BoardCorners corners;
};

/// What the images of the pattern gave.
struct BoardViews {
  std::vector<BoardView> views;                ///< in the order asked for, without those that failed
  std::vector<std::filesystem::path> without;  ///< images without a whole board
  cv::Size image_size;
};

/// Finds the board in every file (once, even if it is named twice), `jobs` at a time. InputError for a file that is not
/// an image, has more than `most_pixels`, or another size than the first.
BoardViews find_board_views(const std::vector<std::filesystem::path>& files, cv::Size inner_corners, int jobs,
                            std::size_t most_pixels = kMostPixels, const base::Progress& progress = base::no_progress);

/// The grey image of a file (core/pictures/frames/read_image.h). Called from several threads at once.
using GreyReader = std::function<cv::Mat(const std::filesystem::path&)>;

/// The same with images from elsewhere, by the names of their files.
BoardViews find_board_views(const std::vector<std::filesystem::path>& files, cv::Size inner_corners, int jobs,
                            const GreyReader& read, const base::Progress& progress = base::no_progress);

/// The views with a board; InputError, naming the images without one, if there are fewer than three.
std::vector<const BoardView*> checked_views(const BoardViews& boards);

/// The views to calibrate with, and notes on the outlying ones.
struct KeptViews {
  std::vector<const BoardView*> views;
  std::vector<Note> notes;
};

/// Drops views whose error is above 0.2 px and above five times the median (one outlier pulls all parameters), unless
/// fewer than three would be left. A note on each outlier says whether it was dropped.
KeptViews without_outliers(const std::vector<const BoardView*>& views, const std::vector<double>& errors_px);

/// File names without their folders, separated by commas.
std::string names_of(const std::vector<std::filesystem::path>& files);

/// The pattern's corners at (i, j) * square, in the order of BoardCorners.
std::vector<cv::Point3d> pattern_points(cv::Size grid, double square_m);

}  // namespace glidelab::core
