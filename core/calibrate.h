/// The camera from views of the calibration pattern, by least squares over all corners (Zhang 2000;
/// cv::calibrateCamera).
///
/// Which parameters: fx, fy, cx, cy, k1, k2 always; k3, and the tangential pair p1, p2, only where the views determine
/// them: a term whose value is below 3 of its standard deviations is fixed to zero (the pair where both are) and the
/// rest fitted again. Leaving such a term out changes the picture by less than its own uncertainty, and an undetermined
/// one would be amplified outside the place where the pattern was seen.
#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/chessboard.h"
#include "core/corner_noise.h"
#include "core/experiment.h"

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

struct Calibration {
  CameraModel camera;
  /// Of fx, fy, cx, cy, k1, k2, p1, p2, k3 (the views' poses are fitted with them); rows of fixed terms are 0.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  CornerNoise noise;    ///< what the covariance assumes of the corners
  double rms_px = 0.0;  ///< per corner (distance), over the views used
  std::size_t views_used = 0;
  std::vector<std::string> notes;
};

/// At least three views with a visible board; else InputError that names the pictures without one. A view whose error
/// is above 0.2 px and five times the median's is left out (with a note).
Calibration calibrate_camera(const BoardViews& boards, double square_m);

}  // namespace glidelab::core
