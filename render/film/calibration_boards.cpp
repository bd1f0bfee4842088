#include "render/film/calibration_boards.h"

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "render/random/streams.h"

namespace glidelab::render {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// A pose as a person would take it: where in the image (parts of its half width and height off the middle), how
/// large (part of the image's width), how tilted (degrees about the image's horizontal and vertical), how turned.
struct Pose {
  double right, down, width, tilt_x_deg, tilt_y_deg, turn_deg;
};

// Every part of the image is covered, every tilt comes with another place; cyclic beyond twelve.
constexpr Pose kPoses[] = {
    {0.00, 0.00, 0.78, 0.0, 0.0, 0.0},        {-0.55, -0.50, 0.52, 25.0, -25.0, 3.0},
    {0.55, -0.50, 0.52, 25.0, 25.0, -4.0},    {-0.55, 0.50, 0.52, -25.0, -25.0, -3.0},
    {0.55, 0.50, 0.52, -25.0, 25.0, 5.0},     {0.00, -0.45, 0.60, 33.0, 0.0, 2.0},
    {0.00, 0.45, 0.60, -33.0, 0.0, -6.0},     {-0.50, 0.00, 0.55, 0.0, -33.0, 8.0},
    {0.50, 0.00, 0.55, 0.0, 33.0, -7.0},      {0.05, 0.05, 0.66, 18.0, -28.0, 25.0},
    {-0.05, -0.05, 0.66, -28.0, 18.0, -25.0}, {0.30, -0.25, 0.50, 12.0, 20.0, 88.0},
};

double jitter(std::uint64_t seed, std::uint32_t view, std::uint32_t number) {
  return 2.0 * uniform_of(random_words(RandomPurpose::pattern_poses, {view, number, 0}, philox_key(seed))[0]) -
         1.0;  // -1 to 1
}

bool wholly_seen(const Camera& camera, const Chessboard& board, double margin_px) {
  const std::vector<Eigen::Vector3d> outline = outline_of(board);
  constexpr int kSteps = 16;  // the lens bends the edges
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const Eigen::Vector3d p = outline[i] + (outline[(i + 1) % outline.size()] - outline[i]) * k / kSteps;
      const auto pixel = project(camera, p);
      if (!pixel || !in_picture(camera, *pixel, margin_px)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Chessboard> calibration_boards(const Scenario& scenario, std::uint64_t seed) {
  const Camera& camera = scenario.camera;
  const PatternSetup& pattern = scenario.pattern;
  std::vector<Chessboard> boards;
  for (int view = 0; view < pattern.views; ++view) {
    Pose pose = kPoses[static_cast<std::size_t>(view) % std::size(kPoses)];
    const auto random = [&](std::uint32_t number) { return jitter(seed, static_cast<std::uint32_t>(view), number); };
    const double tilt_x = (pose.tilt_x_deg + 2.0 * random(0)) * kRadPerDeg;
    const double tilt_y = (pose.tilt_y_deg + 2.0 * random(1)) * kRadPerDeg;
    const double turn = (pose.turn_deg + 3.0 * random(2)) * kRadPerDeg;
    const Eigen::Matrix3d R_CP =
        (Eigen::AngleAxisd(tilt_x, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(tilt_y, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    Chessboard board;
    board.inner_columns = pattern.inner_columns;
    board.inner_rows = pattern.inner_rows;
    board.square_m = pattern.square_m;
    const double plate_m = (pattern.inner_columns + 1 + 2 * board.border_squares) * pattern.square_m;
    const Eigen::Vector3d middle_P(0.5 * (pattern.inner_columns - 1) * pattern.square_m,
                                   0.5 * (pattern.inner_rows - 1) * pattern.square_m, 0.0);
    bool found = false;
    // Moved towards the middle and away from the camera until it is wholly in the image.
    for (int attempt = 0; attempt < 60 && !found; ++attempt) {
      const double inward = std::pow(0.93, attempt);
      const double width = pose.width * std::pow(0.985, attempt);
      const Eigen::Vector2d pixel(0.5 * (camera.width_px - 1) * (1.0 + inward * (pose.right + 0.04 * random(3))),
                                  0.5 * (camera.height_px - 1) * (1.0 + inward * (pose.down + 0.04 * random(4))));
      const auto ray = undistorted_at(camera, pixel);
      if (!ray) continue;
      const double depth = camera.focal_px.x() * plate_m / (width * camera.width_px) * (1.0 + 0.03 * random(5));
      Eigen::Isometry3d X_CP = Eigen::Isometry3d::Identity();
      X_CP.linear() = R_CP;
      X_CP.translation() = depth * ray->homogeneous() - R_CP * middle_P;
      board.X_WP = camera.X_WC * X_CP;
      found = wholly_seen(camera, board, 3.0);
    }
    if (!found) throw base::NumericalError("calibration: no pose of the pattern is wholly in the image");
    boards.push_back(board);
  }
  return boards;
}

}  // namespace glidelab::render
