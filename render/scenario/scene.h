/// The laboratory of a scenario, as drawn by the painters for each image: the static scene, the moving body, and how a
/// scenario makes them.
///
/// World frame, metres. Radiance is relative: a white surface that faces the camera side, at the middle of the light,
/// has radiance 1. A surface's radiance is albedo * light(position) * (ambient + diffuse part), Lambertian, with soft
/// shadows of the boxes; this is a plausible laboratory, not a claim about a real one.
///
/// The line of motion of a set-up with inclination a passes through the world's origin, off the plane z = 0 by the
/// marker's height, along (cos a, -sin a, 0) (track.downhill = +1) or (-cos a, -sin a, 0) (-1).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "render/scenario/scenario_data.h"

namespace glidelab::render {

enum class Surface { matt = 0, aluminium = 1, scale_tape = 2, wood = 3 };

struct StaticBox {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  double turn_rad = 0.0;                             ///< about +z: the box's x axis is (cos, sin, 0)
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();  ///< half its size along its axes
  double albedo = 0.5;
  Surface surface = Surface::matt;
  bool casts_shadow = true;
};

/// A chessboard as a flat plate: X_WP puts its frame (X along the longer row of inner corners, from the side whose
/// corner squares are black; Z away from the printed side) with the first inner corner at the origin.
struct Chessboard {
  Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();
  int inner_columns = 9;
  int inner_rows = 6;
  double square_m = 0.04;
  double border_squares = 1.0;  ///< white margin around the outer squares
  double white_albedo = 0.85;
  double black_albedo = 0.05;
};

/// A vertical line of thread with a bob at its lower end.
struct PlumbLine {
  double x_m = 0.0;
  double z_m = 0.0;
  double top_y_m = 1.0;
  double bottom_y_m = -0.5;
  double diameter_m = 0.0015;
  double bob_diameter_m = 0.025;
  double albedo = 0.03;
};

/// The static scene in front of the camera: wall, boxes (track, feet, table), the plumb line and the calibration
/// pattern.
struct StaticScene {
  double wall_z_m = -0.6;
  double wall_albedo = 0.4;
  double light_falloff = 0.12;  ///< relative darkening of the light at 1 m from its middle
  Eigen::Vector2d light_middle_m = Eigen::Vector2d(-0.2, 0.3);
  Eigen::Vector2d light_gradient_per_m = Eigen::Vector2d::Zero();
  std::vector<StaticBox> boxes;
  std::optional<Chessboard> board;
  std::optional<PlumbLine> plumb;
};

/// light(position) of the scene, for objects drawn elsewhere: exp(gradient · (x, y)) / (1 + falloff * distance²), with
/// the distance in x and y.
inline double light_at(const StaticScene& scene, const Eigen::Vector3d& p_W) {
  return std::exp(scene.light_gradient_per_m.dot(p_W.head<2>())) /
         (1.0 + scene.light_falloff * (p_W.head<2>() - scene.light_middle_m).squaredNorm());
}

/// Light comes from the upper left in front of the track, and its ambient part from all around.
inline const Eigen::Vector3d kToLight = Eigen::Vector3d(-0.35, 0.62, 0.70).normalized();
inline constexpr double kAmbient = 0.45;

/// The shading factor of a surface with this outward normal, 1 if it faces the camera side.
double shade_of(const Eigen::Vector3d& normal_W);

/// Corners of the board's plate, border included, in order around it (world frame).
std::vector<Eigen::Vector3d> outline_of(const Chessboard& board);

/// A rectangle on a face of a box: `corners_W` in order around it.
struct Patch {
  std::array<Eigen::Vector3d, 4> corners_W;
  double radiance = 0.0;
};

struct MovingBox {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_W = Eigen::Matrix3d::Identity();  ///< columns: the box's own right-handed axes
  Eigen::Vector3d half_m = Eigen::Vector3d::Zero();      ///< half its size along them
  std::array<double, 6> radiance{};                      ///< of the faces at -x, +x, -y, +y, -z, +z
  std::vector<Patch> patches;                            ///< drawn on it; visible where the box is visible
};

/// A uniformly bright sphere (retro-reflective sheeting under a light next to the lens).
struct MarkerSphere {
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
  double radiance = 0.0;
};

/// The body that moves along the track, as drawn by the moving painter: boxes, flat patches on them, and the marker's
/// sphere.
///
/// All positions are in the world frame for the body at x = 0 on the track; at x it is shifted by x * direction_W. The
/// painter draws the boxes in the given order, each over the previous ones, and the marker over all of them.
struct MovingBody {
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitX();  ///< the track's +x, of length 1
  std::vector<MovingBox> boxes;
  std::optional<MarkerSphere> marker;
};

/// The track's +x (downhill) in the world, of length 1.
Eigen::Vector3d track_direction_W(const TrackSetup& track, double incline_rad);

/// The marker's centre at x on the track.
Eigen::Vector3d marker_position_W(const Scenario& scenario, double incline_rad, double x_m);

/// Wall, table and track, without the glider.
StaticScene empty_track(const Scenario& scenario, double incline_rad);

/// The glider with its marker, as lit by the scene at x_m on its track.
MovingBody glider(const Scenario& scenario, const StaticScene& scene, const sim::Body& body, double x_m);

/// The board in the plane of motion (z = 0) as in the i-th plane view; the track is that of the first configuration.
Chessboard plane_board(const Scenario& scenario, std::size_t view);

PlumbLine plumb_line(const PlumbSetup& setup, const Camera& camera);

/// A rectangle around the part of the plumb line that is seen in front of the wall, above the track of the first
/// configuration; empty if less than 40 px of it are in the image, or if there is no plumb line.
std::optional<PixelRect> plumb_region(const Scenario& scenario);

/// The scenario as in its clips: with the focal length after the calibration (render/camera/camera.h).
Scenario as_in_clips(const Scenario& scenario);

/// Electrons that a relative radiance of 1 gives in one exposure.
double electrons_of_white(const Scenario& scenario);

}  // namespace glidelab::render
