/// The centre of a matte sphere that is lit from one side, before a background that is known from other frames.
///
/// Light, not codes, adds up. In a pixel of which the sphere covers the part E,
///
///     Y = b (1 - E) + S E,    S = A + max(0, L . n),    code = tone(Y)
///
/// b is the background's light, A what reaches the sphere from all around, L the strength and direction of one lamp
/// (Lambert's law) and n = (x, y, sqrt(1 - x^2 - y^2)) the sphere's normal, with (x, y) = M d / size, d = p - c, and M
/// the outline's ellipse as the calibrated camera sees a sphere of the stated diameter. E is that of a straight edge
/// with a blur in the pixel's square (pixel_signal.h), S the mean over what the sphere covers of the pixel.
///
/// Where the unlit limb is as bright as the background, it says nothing about the centre: then the size, which is that
/// of the whole clip, says where it is. The size is held by a prior; a centroid or a fit of free size follows the
/// light.
///
/// A disc has the outline of a disc, and S = A + L_x x + L_y y.
///
/// Assumes one distant lamp, a matte surface, a background that keeps still and is lit evenly in time. Pixels; the
/// centre of the first pixel is (0, 0). Reference for the tone curve: IEC 61966-2-1 (sRGB).
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/pictures/image/code_tone.h"

namespace glidelab::core {

/// One pixel of a window.
struct SpherePixel {
  double u = 0.0, v = 0.0;
  double code = 0.0;    ///< as a share of the largest
  double behind = 0.0;  ///< light of the background
  double weight = 1.0;
};

/// What the sphere sends to the camera.
struct SphereLight {
  cv::Vec3d lamp;        ///< L: x to the right, y down, z towards the camera
  double ambient = 0.0;  ///< A
};

/// What is known before the fit.
struct SphereGuess {
  cv::Point2d centre;
  cv::Vec3d shape;  ///< the elements uu, uv, vv of M (1/px) for size 1
  double log_size = 0.0;
  double log_size_sd = 0.05;
  double blur_px = 0.1;
  ToneCurve tone = ToneCurve::linear;
  bool flat = false;                 ///< a disc
  double noise = 0.005;              ///< of a pixel's code
  std::optional<SphereLight> light;  ///< nothing: from the pixels inside the guess
};

struct SphereFit {
  cv::Point2d centre;
  double sd_px = 0.0;  ///< of one coordinate, with the size as it is held
  double log_size = 0.0;
  double log_size_sd = 0.0;  ///< by the pixels alone
  SphereLight light;
  double rms = 0.0;       ///< of the residuals, in codes
  double contrast = 0.0;  ///< root mean square of what the sphere adds to the background's codes, where it covers it
  double weight = 0.0;
};

/// Nothing where the fit does not converge or moves by more than a radius.
std::optional<SphereFit> fit_lit_sphere(const std::vector<SpherePixel>& pixels, const SphereGuess& guess);

/// The code that the model gives a pixel.
double lit_sphere_code(const SpherePixel& pixel, const SphereGuess& guess, const SphereFit& fit);

}  // namespace glidelab::core
