/// The camera with a fisheye lens (camera_model.h) from views of the pattern, and which of the two lenses it is.
///
/// cv::fisheye::calibrate; how sure its terms are by pose_elimination.h. Which parameters: fx, fy, cx, cy always; k4,
/// then k3, k2, k1 only where they are determined: from the last on, a term below three of its standard deviations is
/// fixed to zero and the rest fitted again, up to the first that is not.
#pragma once

#include "core/calibrate.h"

namespace glidelab::core {

/// As calibrate_camera (calibrate.h), covariance rows fx, fy, cx, cy, k1, k2, k3, k4, and one of zeros. InputError
/// where no such camera fits.
Calibration calibrate_fisheye(const BoardViews& boards, double square_m);

/// Brown-Conrady, and a fisheye instead where neighbouring corners show that Brown-Conrady does not follow the lens and
/// a fisheye leaves less than kMuchLess of its residuals (both have as many terms).
inline constexpr double kMuchLess = 0.8;
Calibration calibrate_any_lens(const BoardViews& boards, double square_m);

}  // namespace glidelab::core
