/// The errors of a pattern's corners: independent errors, errors that neighbouring corners share, and their map over
/// the image.
///
/// Errors that vary smoothly over a board (from the phase of the pixels, which drifts slowly if squares are nearly a
/// whole number of pixels; from a lens that departs from its model) affect the pose far more than independent noise of
/// the same size. The pose absorbs most of them, so that little is left in the residuals. The model for each view's u
/// and v is
///
///     V = white^2 I + correlated^2 K,     K_ij = exp(-|i - j|^2 / (2 l^2)),   l = 2 squares.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <vector>

#include "core/result/results.h"

namespace glidelab::core {

/// The correlated part is never taken below this: on painted, sharp boards 0.0016 px of smooth error remained where
/// they lie along the rows of pixels, and less than 0.0005 px elsewhere.
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

/// White and correlated size follow from two moments of the residuals r = M e left by fitting the views' poses (M
/// removes what a pose can absorb): the sum of squares, and the sum of products of neighbours along rows and columns.
/// The correlated part counts if the products exceed those of white noise by two standard deviations, and never below
/// kLeastCorrelatedPx.
///
/// `fitted`: how many parameters all views had in common. At least one view.
CornerNoise estimate_corner_noise(const std::vector<ViewResiduals>& views, std::size_t fitted);

/// V times a matrix with a row for u and v of every corner of one view.
Eigen::MatrixXd times_covariance(const CornerNoise& noise, cv::Size grid, const Eigen::MatrixXd& columns);

/// Measured minus modelled, pixels.
struct CornerRest {
  cv::Point2d at, off;
};

/// Adds the residuals of one view, given u, v of corner 0, 1, …
void add_rests(const std::vector<cv::Point2d>& corners, const Eigen::VectorXd& residual,
               std::vector<CornerRest>& rests);

/// A map of the corners' residuals over the image: where a lens departs from its model, the corners of all views are
/// displaced in the same direction.
///
/// The image is cut into cells of equal size. The mean residual of the n corners in a cell is known to s / sqrt(n), s
/// the scatter of all residuals about the means of their cells (u and v together; n - 1 degrees of freedom a cell).
/// `excess` is the root mean square of the cells' means over that: 1 where errors are independent, larger where they
/// are smooth.
///
/// An image of at least 1 x 1 pixels; the longer side has eight cells, the other as many as make them square or wider.
CornerMap corner_map(cv::Size image, const std::vector<CornerRest>& rests);

}  // namespace glidelab::core
