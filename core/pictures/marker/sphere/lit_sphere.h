/// The centre of a matte sphere that is lit from one side, in front of a background that is known from other frames.
///
/// Light adds up; codes do not. In a pixel of which the sphere covers the part E,
///
///     Y = b (1 - E) + S E,    S = A + max(0, L . n),    code = tone(Y)
///
/// Here b is the background's light, A the ambient light, L the strength and direction of one lamp (Lambert's law) and
/// n = (x, y, sqrt(1 - x^2 - y^2)) the normal of the sphere, with (x, y) = M d / size and d = p - c. M is the ellipse
/// of the outline of a sphere of the stated diameter, as the calibrated camera sees it. E is that of a straight blurred
/// edge across a square pixel (core/pictures/image/pixel_signal.h). S is averaged over the covered part of the pixel.
///
/// Where the unlit limb is as bright as the background, it says nothing about the centre; the size, which a prior holds
/// at that of the whole clip, then does. A centroid, or a fit with a free size, would follow the light.
///
/// A disc has the outline of a disc, and S = A + L_x x + L_y y.
///
/// Assumes one distant lamp, a matte surface, and a still background under constant light. Lengths are in pixels, and
/// the centre of the first pixel is (0, 0). Codes and light are relative to full scale. Reference for the tone curve:
/// IEC 61966-2-1 (sRGB).
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/pictures/image/pixel_signal.h"

namespace glidelab::core {

/// One pixel of a window.
struct SpherePixel {
  double u = 0.0, v = 0.0;
  double code = 0.0;    ///< relative to full scale
  double behind = 0.0;  ///< light of the background
  double weight = 1.0;
};

/// The light that the sphere sends to the camera, relative to full scale.
struct SphereLight {
  cv::Vec3d lamp;        ///< L: x to the right, y down, z towards the camera
  double ambient = 0.0;  ///< A
};

/// What is known before a fit.
struct SphereGuess {
  cv::Point2d centre;
  cv::Vec3d shape;  ///< the elements uu, uv, vv of M (1/px), for size 1
  double log_size = 0.0;
  double log_size_sd = 0.05;
  double blur_px = 0.1;
  ToneCurve tone = ToneCurve::linear;
  bool flat = false;                 ///< a disc
  double noise = 0.005;              ///< standard deviation of a pixel's code
  std::optional<SphereLight> light;  ///< empty: taken from the pixels inside the guess
};

struct SphereFit {
  cv::Point2d centre;
  double sd_px = 0.0;  ///< of one coordinate, with the prior of the size
  double log_size = 0.0;
  double log_size_sd = 0.0;  ///< by the pixels alone, without the prior
  SphereLight light;
  double rms = 0.0;       ///< of the residuals, in codes
  double contrast = 0.0;  ///< root mean square difference between the sphere's and the background's codes
  double weight = 0.0;
};

/// The fit of a window. Empty for fewer than 21 pixels, if the normal equations cannot be solved or the size leaves its
/// range, and if the centre moves by more than a radius. A fit that runs out of iterations counts: the edge of the
/// shadow between pixels may keep the last thousandth of a pixel from settling.
std::optional<SphereFit> fit_lit_sphere(const std::vector<SpherePixel>& pixels, const SphereGuess& guess);

/// The code of a pixel by the model, relative to full scale.
double lit_sphere_code(const SpherePixel& pixel, const SphereGuess& guess, const SphereFit& fit);

}  // namespace glidelab::core
