/// What a lens does to directions: undistorted coordinates (x, y) = (X/Z, Y/Z) become distorted ones, as calibration
/// programs write them. With r² = x² + y²:
///
/// Brown-Conrady (5 coefficients) and its rational form (8):
///
///     R   = (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶)
///     x_d = x R + 2 p1 x y + p2 (r² + 2 x²)
///     y_d = y R + p1 (r² + 2 y²) + 2 p2 x y
///
/// Fisheye, equidistant: theta = atan(r), theta_d = theta (1 + k1 theta² + k2 theta⁴ + k3 theta⁶ + k4 theta⁸),
/// (x_d, y_d) = (x, y) theta_d / r; directions less than 90 degrees off the axis.
///
/// Sources: D. C. Brown, "Close-range camera calibration", Photogrammetric Engineering 37 (1971), in the order of terms
/// that calibration programs print; J. Kannala and S. S. Brandt, "A generic camera model and calibration method for
/// conventional, wide-angle, and fish-eye lenses", IEEE TPAMI 28 (2006). Everything here is in double; validity ends
/// where the mapping folds over.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace glidelab::render {

enum class LensModel { brown_conrady, rational, fisheye };

struct Lens {
  double k1 = 0.0;
  double k2 = 0.0;
  double k3 = 0.0;
  double p1 = 0.0;
  double p2 = 0.0;
  double k4 = 0.0;  ///< rational and fisheye
  double k5 = 0.0;  ///< rational
  double k6 = 0.0;  ///< rational
  LensModel model = LensModel::brown_conrady;
};

/// "brown-conrady", "rational", "fisheye".
const char* name_of(LensModel model);

/// Where the lens moves the undistorted point (x, y).
Eigen::Vector2d distort(const Lens& lens, const Eigen::Vector2d& undistorted);

/// d(x_d, y_d) / d(x, y).
Eigen::Matrix2d distortion_jacobian(const Lens& lens, const Eigen::Vector2d& undistorted);

/// The radius sqrt(x² + y²) at which the radial part stops growing (or has a pole); infinity where it never does.
/// Beyond it the formula maps points back into the image that no lens would show there.
double fold_radius(const Lens& lens);

/// The undistorted point that the lens moves to `distorted`, to 1e-14 of the focal length. Nothing where there is none
/// inside the fold radius.
std::optional<Eigen::Vector2d> undistort(const Lens& lens, const Eigen::Vector2d& distorted);

/// The same with `largest_radius` in place of the fold radius, for a caller who asks many times.
std::optional<Eigen::Vector2d> undistort(const Lens& lens, const Eigen::Vector2d& distorted, double largest_radius);

}  // namespace glidelab::render
