/// A map of the corners' residuals over the image: where a lens departs from its model, the corners of all views are
/// displaced in the same direction.
///
/// The image is cut into cells of equal size. The mean residual of the n corners in a cell is known to s / sqrt(n), s
/// the scatter of all residuals about the means of their cells (u and v together; n - 1 degrees of freedom a cell).
/// `excess` is the root mean square of the cells' means over that: 1 where errors are independent, larger where they
/// are smooth.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <vector>

#include "core/result/results.h"

namespace glidelab::core {

/// Measured minus modelled, pixels.
struct CornerRest {
  cv::Point2d at, off;
};

/// Adds the residuals of one view, given u, v of corner 0, 1, …
void add_rests(const std::vector<cv::Point2d>& corners, const Eigen::VectorXd& residual,
               std::vector<CornerRest>& rests);

/// An image of at least 1 x 1 pixels; the longer side has eight cells, the other as many as make them square or wider.
CornerMap corner_map(cv::Size image, const std::vector<CornerRest>& rests);

}  // namespace glidelab::core
