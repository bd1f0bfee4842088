/// The camera from views of the calibration pattern, by least squares over all corners (Zhang 2000;
/// cv::calibrateCamera).
///
/// Which parameters: fx, fy, cx, cy always; of the distortion only the terms that the views support. From all five
/// (k1, k2, p1, p2, k3) on, k3, then the pair p1, p2, then k2, then k1 are tested: v' C^-1 v of the term with its
/// covariance C (of correlated corner errors, as below) against 9 for one term and 11.8 for the pair (three standard
/// deviations, 0.27 %; with white errors that is the F-test of the nested models). A term below it is fixed to zero and
/// the rest fitted again; k2 is tested only without k3, k1 only without k2. So a lens without distortion gets none, and
/// no undetermined term is amplified outside the place where the pattern was seen.
///
/// Lenses move the picture's corner by a part of N(0, 0.3²) with k1, N(0, 0.2²) with k2, N(0, 0.1²) with k3. That is an
/// assumption, two to four times the largest of the three measured calibrations in scenarios/cameras (a C920: 0.07,
/// -0.10, 0.02), for wider lenses are in use. A radial term counts as far as that leaves it: with the sd s of its part
/// at the corner, v' C^-1 v and the term's value times usual² / (usual² + s²). What the views know ten times better
/// loses 1 %; noise that would bend the picture's sides by half is no term.
///
/// A term that was left out may still be there, and a fit without it then errs by more than its own covariance: what
/// the term's uncertainty did to all terms, C_a C^-1 C_a' (C_a the covariance of all with it; as far as it is believed
/// that is), and the part of its value that is more than noise, (1 - q / (v' C^-1 v)) for q terms, are added to the
/// covariance. So leaving terms out makes no result look surer.
#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

#include "core/camera_model.h"
#include "core/chessboard.h"
#include "core/corner_map.h"
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
  CornerMap rests;      ///< what the fit leaves, over the picture
  std::string model;    ///< the distortion's terms, and the tests of those that were looked at
  double rms_px = 0.0;  ///< per corner (distance), over the views used
  std::size_t views_used = 0;
  std::vector<std::string> notes;
};

/// The views with a board; InputError that names the pictures without one where there are fewer than three.
std::vector<const BoardView*> checked_views(const BoardViews& boards);

/// Without those whose error is above 0.2 px and five times the median's (one that is off pulls all parameters), with a
/// note of each; all of them where fewer than three would be left.
std::vector<const BoardView*> without_outliers(const std::vector<const BoardView*>& views,
                                               const std::vector<double>& errors_px, std::vector<std::string>& notes);

/// What a reader should know of the views that were used, and of how they fit.
void add_notes_on_views(const BoardViews& boards, const std::vector<const BoardView*>& used, Calibration& calibration);

/// At least three views with a visible board; else InputError that names the pictures without one. A view whose error
/// is above 0.2 px and five times the median's is left out (with a note).
Calibration calibrate_camera(const BoardViews& boards, double square_m);

}  // namespace glidelab::core
