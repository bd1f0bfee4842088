/// What stands still before the camera: wall, boxes (track, feet, table), the plumb line and the calibration pattern.
///
/// World frame, metres. Radiance is relative: a white surface that faces the camera side, at the middle of the light,
/// has radiance 1. A surface's radiance is albedo * light(position) * (ambient + diffuse part), Lambertian, with soft
/// shadows of the boxes; that is a plausible laboratory, not a claim about a real one.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <vector>

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
/// corner squares are black; Z away from the side that is printed) with the first inner corner at the origin.
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

struct StaticScene {
  double wall_z_m = -0.6;
  double wall_albedo = 0.4;
  double light_falloff = 0.12;  ///< how much darker the light is 1 m off its middle
  Eigen::Vector2d light_middle_m = Eigen::Vector2d(-0.2, 0.3);
  Eigen::Vector2d light_gradient_per_m = Eigen::Vector2d::Zero();
  std::vector<StaticBox> boxes;
  std::optional<Chessboard> board;
  std::optional<PlumbLine> plumb;
};

/// light(position) of the scene, for what is drawn elsewhere: exp(gradient · (x, y)) / (1 + falloff * distance²), the
/// distance over x and y.
inline double light_at(const StaticScene& scene, const Eigen::Vector3d& p_W) {
  return std::exp(scene.light_gradient_per_m.dot(p_W.head<2>())) /
         (1.0 + scene.light_falloff * (p_W.head<2>() - scene.light_middle_m).squaredNorm());
}

/// Light comes from the upper left before the track, and its ambient part from all around.
inline const Eigen::Vector3d kToLight = Eigen::Vector3d(-0.35, 0.62, 0.70).normalized();
inline constexpr double kAmbient = 0.45;

/// The factor of a surface with this outward normal, 1 where it faces the camera side.
double shade_of(const Eigen::Vector3d& normal_W);

/// Corners of the board's plate, border included, in order around it (world frame).
std::vector<Eigen::Vector3d> outline_of(const Chessboard& board);

}  // namespace glidelab::render
