/// What a render writes besides the clips: experiment.toml and the truth (the true values, the marker's true position
/// in every frame, from the exact image of a sphere, and ideal frames).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "render/camera/camera.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario.h"

namespace glidelab::render {

/// Names within the experiment folder, of the i-th of `count` images.
std::string view_name(std::size_t i);
std::string plane_name(std::size_t i, std::size_t count);

/// experiment.toml: what the photographer of these images would write; it contains no truth.
std::string experiment_toml(const Scenario& scenario);

/// truth.json: the values that were put in. The seed is the one that was used.
std::string truth_json(const Scenario& scenario, std::uint64_t seed);

/// The position on the track of the pattern's first corner, projected onto the line of motion of this inclination.
double x_origin_m(const Scenario& scenario, double incline_rad);

/// The exact image of a sphere, for a marker's true place in a frame.
///
/// A sphere of radius r about c (camera frame) fills the cone of rays d with (d·c)² >= (|c|² - r²) |d|². On the plane
/// z = 1 of undistorted coordinates that is an ellipse, whose centre is not the projection of the sphere's centre. The
/// lens then bends the ellipse; the photometric centre of the image is the centroid of the bent area.
///
/// In undistorted coordinates: points center + axis_u cos(t) + axis_v sin(t).
struct Ellipse {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis_u = Eigen::Vector2d::Zero();
  Eigen::Vector2d axis_v = Eigen::Vector2d::Zero();
};

/// Empty if the sphere is not entirely in front of the camera (c.z <= r).
std::optional<Ellipse> image_of_sphere(const Eigen::Vector3d& center_C, double radius_m);

struct AreaMoments {
  double area_px = 0.0;  ///< in square pixels
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
};

/// Area and centroid of an ellipse's image under the lens: the integrals of 1 and of the pixel position over the
/// ellipse with the mapping's Jacobian, by Gauss-Legendre in the radius and the trapezoid rule in the angle (exact
/// within rounding for the polynomials of a lens).
AreaMoments image_of(const Camera& camera, const Ellipse& ellipse);

/// The true position of the marker in a frame's image, for the truth folder.
///
/// A frame shows the marker at the middle of the exposure of the row on which its centre lies (with a global shutter,
/// of any row). Centre: the projection of the sphere's centre. Centroid: of the area of the sphere's sharp image at
/// that instant, which differs by the effect of perspective and lens on a sphere (about 1e-3 px for a small one).
struct MarkerInImage {
  double t_s = 0.0;  ///< the instant, on the recording's clock
  double x_m = 0.0;  ///< on the track, at that instant
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
};

/// Empty if the centre lies outside the image. NumericalError if the marker outruns a rolling readout.
std::optional<MarkerInImage> marker_in_image(const Scenario& scenario, const sim::Body& body, const FrameMotion& frame);

/// The second product of a render: frames as taken by a perfect camera, and the marker's position in each.
///
/// Ideal frames are free of all imperfections (no lens distortion, no blur, an instantaneous exposure, no vignetting,
/// uniform light, a mount at rest, no noise), taken by the same pinhole at rest, at each frame's time (the middle of
/// the middle row's exposure; slot by slot of a clock without error, jitter, dropped and repeated frames). They have 8
/// bits: the code is 0.75 · 255 times the radiance, rounded and limited to 255, so that white is 191.
///
/// Writes `ideal-<clip>.mkv` (MagicYUV) and `ideal-<clip>.csv` (frame,t_s,u_px,v_px: the projection of the marker's
/// centre, for the frames that contain it) of every clip into `truth_dir`, on up to `jobs` threads.
void write_ideal_frames(const Scenario& scenario, const std::filesystem::path& truth_dir, int jobs);

}  // namespace glidelab::render
