/// The camera with a fisheye lens (camera_model.h) from views of the pattern, and which of the two lenses it is.
///
/// cv::fisheye::calibrate, with uncertainties by pose_elimination.h. Parameters: fx, fy, cx, cy always; k1 to k4 only
/// if they are determined: from k4 down, a term below three of its standard deviations is fixed to zero and the rest
/// fitted again, until the first that is significant.
#pragma once

#include <optional>

#include "core/pictures/camera/calibrate.h"

namespace glidelab::core {

/// As calibrate_camera (calibrate.h); the rows of the covariance are fx, fy, cx, cy, k1, k2, k3, k4, and one of zeros.
/// Nothing if OpenCV finds no such camera.
std::optional<Calibration> calibrate_fisheye(const BoardViews& boards, double square_m);

/// Twice the logarithm of the likelihood ratio above which a lens is modelled as a fisheye.
inline constexpr double kDecisive = 100.0;

/// Brown-Conrady, or a fisheye where that explains the corners decisively better: n log(rms² / rms²) > kDecisive over n
/// coordinates (twice the logarithm of the likelihood ratio; both models have as many terms, and some ten neighbouring
/// corners share their errors). A fisheye is tried where the image's corner is more than 0.8 focal lengths off the
/// axis, or neighbouring corners show that Brown-Conrady does not describe the lens.
Calibration calibrate_any_lens(const BoardViews& boards, double square_m);

}  // namespace glidelab::core
