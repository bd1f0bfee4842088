/// Optics of the true camera: sharpness, vignetting, and the exact ray of every pixel.
#pragma once

#include <Eigen/Core>

#include <limits>
#include <vector>

#include "render/camera/camera.h"
#include "render/image/float_image.h"

namespace glidelab::render {

/// Sharpness: the thin lens's disc of confusion, and a Gaussian core of diffraction.
///
/// A lens of the focal length f = s d / (s + d), s = focal_px · pixel pitch being the distance from lens to sensor and
/// d the focus distance, with the aperture D = f / N: a point at depth Z is spread uniformly over a disc of diameter D
/// |1/Z - 1/d| in undistorted coordinates, times focal_px in the image. A point a of the aperture sees the point (X, Y,
/// Z) at (X/Z, Y/Z) - a (1/Z - 1/d). The core is a Gaussian with sigma = 0.42 lambda N s / f, the closest to the Airy
/// disc, with other blur (`core_px`) added in quadrature. The image is also integrated over the pixel's square. Source:
/// M. Born and E. Wolf, Principles of Optics, 8.5.2; B. Zhang et al., Applied Optics 46 (2007), for 0.42.
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

/// One of the rays whose mean is a blurred image.
struct FocusSample {
  Eigen::Vector2d aperture = Eigen::Vector2d::Zero();  ///< in the unit disc
  Eigen::Vector2d core = Eigen::Vector2d::Zero();      ///< of a normal distribution with variance 1
  Eigen::Vector2d place = Eigen::Vector2d::Zero();     ///< in the pixel, -1/2 to 1/2
};

/// `count` samples, uniformly spread in all six dimensions (Roberts' R6 sequence); aperture and core have mean 0 and
/// the exact covariance, 1/4 and 1 on the diagonal. `count` is even: samples come in opposite pairs.
std::vector<FocusSample> focus_samples(std::size_t count);

/// The darkening of the image towards its corners.
///
/// cos⁴: the illumination of a flat sensor behind a simple lens, cos⁴ of the angle between the ray and the optical
/// axis. Radial: a table of gains as a function of the distance from the principal point in pixels, linear between its
/// entries; it multiplies the former. Applied to the light, before the sensor.
struct Vignetting {
  bool cos4 = false;
  std::vector<Eigen::Vector2d> radial;  ///< (radius_px, gain), radii rising from 0 to beyond the farthest corner

  bool none() const { return !cos4 && radial.empty(); }
};

/// The gain at a pixel to which the ray with these undistorted coordinates leads. std::logic_error beyond the table.
double gain_at(const Vignetting& vignetting, const Camera& camera, const Eigen::Vector2d& pixel,
               const Eigen::Vector2d& undistorted);

/// The largest distance of a pixel's centre from the principal point.
double farthest_radius_px(const Camera& camera);

/// A rectangle in undistorted coordinates; empty until something is added.
struct RayBounds {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
};

inline void add_to(RayBounds& bounds, const Eigen::Vector2d& point) {
  bounds.low = bounds.low.cwiseMin(point);
  bounds.high = bounds.high.cwiseMax(point);
}
inline void add_to(RayBounds& bounds, const RayBounds& other) {
  bounds.low = bounds.low.cwiseMin(other.low);
  bounds.high = bounds.high.cwiseMax(other.high);
}
inline bool overlap(const RayBounds& a, const RayBounds& b) {
  return a.low.x() <= b.high.x() && b.low.x() <= a.high.x() && a.low.y() <= b.high.y() && b.low.y() <= a.high.y();
}

/// The image is divided into tiles of kRayTile x kRayTile pixels, starting at its first pixel.
inline constexpr int kRayTile = 8;

/// The exact inverse of the camera's mapping at every pixel, its derivative there, and the relative illumination.
///
/// For the pixel (u, v) the table gives the undistorted coordinates (x, y) of the ray through its centre, and the
/// Jacobian d(x, y)/d(u, v). Within a pixel the mapping is taken as linear; the neglected second order is below
/// |d²x/du²|/8, 3e-5 px for the strongest lens that `why_not_one_to_one` accepts in an image of 800 px. Computed in
/// double and rounded once to single precision: 2^-25 of half the image's width, 1e-5 px.
struct RayTable {
  int width = 0;
  int height = 0;
  std::vector<float> x_y_dxdu_dxdv;  ///< four floats per pixel
  std::vector<float> dydu_dydv;      ///< two floats per pixel
  std::vector<float> gain;           ///< one per pixel, for its light; empty if it is 1 everywhere
  std::vector<RayBounds> tiles;      ///< bounds of the rays of each tile's pixels, including their whole squares; row
                                     ///< by row
  double fold_radius = 0.0;          ///< of the lens

  const RayBounds& tile(int column, int row) const {
    return tiles[static_cast<std::size_t>(row) * ((width + kRayTile - 1) / kRayTile) + column];
  }
};

/// NumericalError if a pixel has no ray (a camera that `why_not_one_to_one` would refuse).
RayTable make_ray_table(const Camera& camera, const Vignetting& vignetting = {});

}  // namespace glidelab::render
