/// The errors of a pattern's corners: independent ones, and ones that neighbouring corners have in common.
///
/// What makes a corner finder err smoothly over a board (the phase of the pixels, which drifts slowly where squares are
/// nearly a whole number of pixels; the lens where the model does not follow it) counts far more for the pose than
/// noise of the same size, and the pose takes most of it up, so that little is left in the residuals. The model for
/// each view's u and v is
///
///     V = white^2 I + correlated^2 K,     K_ij = exp(-|i - j|^2 / (2 l^2)),   l = 2 squares.
///
/// Both sizes follow from two moments of the residuals r = M e left by fitting the views' poses (M takes out what a
/// pose can): the sum of squares, and the sum of products of neighbours along rows and columns. The correlated part
/// counts where the products exceed those of white noise by two standard deviations, and never below
/// kLeastCorrelatedPx: on painted, sharp boards 0.0016 px of smooth error was seen to remain where they lie along the
/// pixels' rows, and less than 0.0005 px elsewhere.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <vector>

namespace glidelab::core {

inline constexpr double kLeastCorrelatedPx = 0.001;

struct CornerNoise {
  double white_px = 0.0;       ///< of one coordinate
  double correlated_px = 0.0;  ///< of one coordinate
};

/// One view: residuals u, v of corner 0, 1, … (row by row), and their derivatives by the view's six pose parameters.
struct ViewResiduals {
  cv::Size grid;
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, 6> by_pose;
};

/// `fitted`: how many parameters all views had in common. At least one view.
CornerNoise estimate_corner_noise(const std::vector<ViewResiduals>& views, std::size_t fitted);

/// V times a matrix with a row for u and v of every corner of one view.
Eigen::MatrixXd times_covariance(const CornerNoise& noise, cv::Size grid, const Eigen::MatrixXd& columns);

}  // namespace glidelab::core
