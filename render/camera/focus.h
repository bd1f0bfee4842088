/// Sharpness: the thin lens's disc of confusion, and a Gaussian core of diffraction.
///
/// A lens of the focal length f = s d / (s + d), s = focal_px · pixel pitch being the distance from lens to sensor and
/// d the focus distance, with the aperture D = f / N: a point at depth Z is spread evenly over a disc of the diameter
/// D |1/Z - 1/d| in undistorted coordinates, times focal_px in the image. A point a of the aperture sees the point
/// (X, Y, Z) at (X/Z, Y/Z) - a (1/Z - 1/d). The core is a Gaussian with sigma = 0.42 lambda N s / f, the one nearest to
/// Airy's disc, and in quadrature what else blurs (`core_px`). The pixel's square is integrated over besides. Source:
/// M. Born and E. Wolf, Principles of Optics, 8.5.2; B. Zhang et al., Applied Optics 46 (2007), for 0.42.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "render/camera/camera.h"

namespace glidelab::render {

struct Focus {
  double f_number = 0.0;
  double focus_distance_m = 0.0;
  double pixel_pitch_m = 0.0;
  double wavelength_m = 550e-9;
  double core_px = 0.0;  ///< standard deviation of a further Gaussian blur
};

/// The aperture's radius in metres.
double aperture_radius_m(const Focus& focus, const Camera& camera);

/// The radius of the disc of a point at this depth, in pixels.
double disc_radius_px(const Focus& focus, const Camera& camera, double depth_m);

/// The standard deviation of the core, in pixels.
double core_sigma_px(const Focus& focus, const Camera& camera);

/// One of the rays of which a blurred image is the mean.
struct FocusSample {
  Eigen::Vector2d aperture = Eigen::Vector2d::Zero();  ///< in the unit disc
  Eigen::Vector2d core = Eigen::Vector2d::Zero();      ///< of a normal distribution with variance 1
  Eigen::Vector2d place = Eigen::Vector2d::Zero();     ///< in the pixel, -1/2 to 1/2
};

/// `count` samples, evenly spread in all six dimensions (Roberts' R6 sequence); aperture and core have mean 0 and the
/// exact covariance, 1/4 and 1 on the diagonal. `count` is even: samples come in opposite pairs.
std::vector<FocusSample> focus_samples(std::size_t count);

}  // namespace glidelab::render
