/// The true camera: a pinhole with a pose and a lens, on a mount that may move.
///
/// Frames (CONVENTIONS.md): W world, C camera (x right, y down, z forward); p_W = X_WC * p_C. A point at (X, Y, Z)_C
/// has the undistorted coordinates (x, y) = (X/Z, Y/Z), the lens moves it to (x_d, y_d), and it appears at the pixel
/// (u, v) = (fx x_d + cx, fy y_d + cy); the centre of the first pixel is (0, 0). Everything here is in double.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace glidelab::render {

enum class LensModel { brown_conrady, rational, fisheye };

/// The effect of a lens on directions: undistorted coordinates (x, y) = (X/Z, Y/Z) become distorted ones, in the
/// notation of calibration programs. With r² = x² + y²:
///
/// Brown-Conrady (5 coefficients) and its rational form (8):
///
///     R   = (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶)
///     x_d = x R + 2 p1 x y + p2 (r² + 2 x²)
///     y_d = y R + p1 (r² + 2 y²) + 2 p2 x y
///
/// Fisheye, equidistant: theta = atan(r), theta_d = theta (1 + k1 theta² + k2 theta⁴ + k3 theta⁶ + k4 theta⁸), (x_d,
/// y_d) = (x, y) theta_d / r; directions less than 90 degrees off the axis.
///
/// Validity ends where the mapping folds over. Sources: D. C. Brown, "Close-range camera calibration", Photogrammetric
/// Engineering 37 (1971), with the order of terms used by calibration programs; J. Kannala and S. S. Brandt, "A generic
/// camera model and calibration method for conventional, wide-angle, and fish-eye lenses", IEEE TPAMI 28 (2006).
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

/// The point to which the lens moves the undistorted point (x, y).
Eigen::Vector2d distort(const Lens& lens, const Eigen::Vector2d& undistorted);

/// d(x_d, y_d) / d(x, y).
Eigen::Matrix2d distortion_jacobian(const Lens& lens, const Eigen::Vector2d& undistorted);

/// The radius sqrt(x² + y²) at which the radial part stops growing (or has a pole); infinity if it never does. Beyond
/// it the formula maps points back into the image, as no lens would.
double fold_radius(const Lens& lens);

/// The undistorted point that the lens moves to `distorted`, to 1e-14 of the focal length. Empty if there is none
/// inside the fold radius.
std::optional<Eigen::Vector2d> undistort(const Lens& lens, const Eigen::Vector2d& distorted);

/// The same with `largest_radius` in place of the fold radius, for repeated calls.
std::optional<Eigen::Vector2d> undistort(const Lens& lens, const Eigen::Vector2d& distorted, double largest_radius);

struct Camera {
  int width_px = 0;
  int height_px = 0;
  Eigen::Vector2d focal_px = Eigen::Vector2d::Zero();   ///< fx, fy
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  ///< principal point cx, cy
  Lens lens;
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
};

/// Undistorted coordinates of a pixel, or empty (see above).
std::optional<Eigen::Vector2d> undistorted_at(const Camera& camera, const Eigen::Vector2d& pixel);

/// The pixel at which undistorted coordinates appear; also outside the image. Empty beyond the fold radius.
std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted);

/// The same with `largest_radius` in place of the fold radius, for repeated calls.
std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted,
                                        double largest_radius);

/// The pixel at which a point of the world appears; also outside the image. Empty for a point behind the camera or
/// beyond the fold radius.
std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& p_W);

/// Whether a pixel position lies on the image, at least `margin_px` inside its outermost pixel centres.
bool in_image(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px = 0.0);

/// X_WC of a camera at `position_W` that looks at `target_W` with the world's +y upward in the image, then rotated by
/// `roll_rad` about its optical axis, clockwise as seen from behind the camera. The line of sight must not be vertical.
Eigen::Isometry3d look_at(const Eigen::Vector3d& position_W, const Eigen::Vector3d& target_W, double roll_rad);

/// Why the lens does not map rays one-to-one on the whole image (with half a pixel around it); empty if it does: every
/// point of the image must have an inverse that Newton's method reaches, with a positive Jacobian, inside the fold
/// radius; checked along the border and on a grid of at most 16 px.
std::optional<std::string> why_not_one_to_one(const Camera& camera);

enum class MountAxis { x, y, z, pan, tilt, roll };

/// In metres for x, y and z; in radians for the others.
struct MountMotion {
  MountAxis axis = MountAxis::pan;
  double offset = 0.0;
  double drift_per_s = 0.0;
  double amplitude = 0.0;
  double frequency_hz = 0.0;
  double phase_rad = 0.0;
};

/// A moving camera, and one whose focus was changed after the calibration.
///
/// Each motion is along or about one of the camera's own axes: X_WC(t) = X_WC T(x, y, z) R_y(pan) R_x(tilt) R_z(roll),
/// where each of the six is the sum over the motions of that axis of
///
///     offset + drift t + amplitude sin(2 pi f t + phase),
///
/// t is measured from the clip's first exposure. The calibration's images are taken with all six at 0 and with the
/// focal length of the camera's section; the clips with (1 + focal_change) times it.
struct Mount {
  double focal_change = 0.0;
  std::vector<MountMotion> motions;

  bool moves() const { return !motions.empty(); }
};

/// The displacement of the camera by the mount at an instant: X_WC(t) = X_WC * this.
Eigen::Isometry3d mount_at(const Mount& mount, double t_s);

/// The largest shift of the image's middle and corners when a camera is moved in this way; for objects 1 m away or
/// farther.
double image_shift_px(const Camera& camera, const Eigen::Isometry3d& moved);

}  // namespace glidelab::render
