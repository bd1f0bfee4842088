/// The camera with a fisheye lens (camera_model.h) from views of the pattern, and which of the two lenses it is.
///
/// cv::fisheye::calibrate; how sure its terms are by pose_elimination.h. Which parameters: fx, fy, cx, cy always; k4,
/// then k3, k2, k1 only where they are determined: from the last on, a term below three of its standard deviations is
/// fixed to zero and the rest fitted again, up to the first that is not.
#pragma once

#include <optional>

#include "core/pictures/camera/calibrate.h"

namespace glidelab::core {

/// As calibrate_camera (calibrate.h), covariance rows fx, fy, cx, cy, k1, k2, k3, k4, and one of zeros. Nothing where
/// OpenCV finds no such camera.
std::optional<Calibration> calibrate_fisheye(const BoardViews& boards, double square_m);

/// Twice the logarithm of the likelihoods' ratio from which on a lens is taken as a fisheye.
inline constexpr double kDecisive = 100.0;

/// Brown-Conrady, or a fisheye where that explains the corners decisively better: n log(rms² / rms²) > kDecisive over n
/// coordinates (twice the logarithm of the likelihoods' ratio; both have as many terms, and neighbouring corners, some
/// ten together, err alike). A fisheye is tried where the picture's corner is more than 0.8 focal lengths off the axis,
/// or neighbouring corners show that Brown-Conrady does not follow the lens.
Calibration calibrate_any_lens(const BoardViews& boards, double square_m);

}  // namespace glidelab::core
