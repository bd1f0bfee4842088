/// What a camera's fit leaves of the pattern's corners, over the picture: where a lens does what its model does not,
/// corners of all views lie off the same way.
///
/// The picture is cut into cells of equal size. Of the n corners in a cell the mean rest is known to s / sqrt(n), s the
/// scatter of all corners' rests about their cells' means (u and v together; n - 1 of each cell's are free). `excess`
/// is the root mean square of the cells' means over that: 1 where errors are independent, larger where they are smooth.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <vector>

#include "core/result/results.h"

namespace glidelab::core {

/// Measured less modelled, pixels.
struct CornerRest {
  cv::Point2d at, off;
};

/// Rests of one view from its corners and the residuals u, v of corner 0, 1, …
void add_rests(const std::vector<cv::Point2d>& corners, const Eigen::VectorXd& residual,
               std::vector<CornerRest>& rests);

/// A picture of at least 1 x 1 pixels; the longer side has eight cells, the other as many as make them square or wider.
CornerMap corner_map(cv::Size picture, const std::vector<CornerRest>& rests);

}  // namespace glidelab::core
