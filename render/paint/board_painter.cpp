#include "render/paint/board_painter.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "base/math/extent.h"
#include "render/paint/static_painter.h"

namespace glidelab::render {
namespace {

/// Times t in [0, last] at which from + t along may be within [-half, half] on an axis, for any of the starts and
/// directions.
base::Extent times_within(const base::Extent& from, const base::Extent& along, double half, double last) {
  base::Extent times{0.0, last};
  // from.low + t along.low <= half, and from.high + t along.high >= -half
  const auto require = [&times](double constant, double slope) {  // constant + t slope >= 0
    if (slope == 0.0) {
      if (constant < 0.0) times.high = -1.0;
    } else if (slope > 0.0) {
      times.low = std::max(times.low, -constant / slope);
    } else {
      times.high = std::min(times.high, -constant / slope);
    }
  };
  require(half - from.low, -along.low);
  require(from.high + half, along.high);
  return times;
}

/// Whether a ray from any of the starts along any of the directions (each within the box around them) may meet the box
/// before the fraction `last` of its length.
template <typename Starts, typename Directions>
bool may_meet(const StaticBox& box, const Starts& starts_W, const Directions& directions_W, double last) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-box.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  base::Extent times{0.0, last};
  for (int axis = 0; axis < 3; ++axis) {
    base::Extent from, along;
    for (const Eigen::Vector3d& start : starts_W) from.include(turn.row(axis).dot(start - box.center_W));
    for (const Eigen::Vector3d& direction : directions_W) along.include(turn.row(axis).dot(direction));
    const base::Extent here = times_within(from, along, box.half_m[axis], last);
    times = {std::max(times.low, here.low), std::min(times.high, here.high)};
  }
  return times.low <= times.high;
}

/// Corners of the cube of directions in which part of the lamp is seen (static_shader.cpp).
std::array<Eigen::Vector3d, 8> lamp_directions() {
  constexpr double kHalfWidth = 0.05;
  std::array<Eigen::Vector3d, 8> directions;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3d corner((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
    directions[i] = kToLight + kHalfWidth * corner;
  }
  return directions;
}

}  // namespace

bool stands_free(const Camera& camera, const StaticScene& scene) {
  if (!scene.board) return false;
  const std::vector<Eigen::Vector3d> corners = outline_of(*scene.board);
  const Eigen::Vector3d eye = camera.X_WC.translation();
  std::vector<Eigen::Vector3d> sight;
  for (const Eigen::Vector3d& corner : corners) {
    sight.push_back(corner - eye);
    const bool before_wall = corner.z() > scene.wall_z_m;
    const bool printed_side = scene.board->X_WP.linear().col(2).dot(sight.back()) > 0.0;
    if (!before_wall || !printed_side || !((camera.X_WC.inverse() * corner).z() > 0.0)) return false;
  }
  constexpr double kUnlimited = 1e9;  // of the vectors to the lamp
  return std::ranges::none_of(scene.boxes, [&](const StaticBox& box) {
    return may_meet(box, std::array{eye}, sight, 1.0) ||
           (box.casts_shadow && may_meet(box, corners, lamp_directions(), kUnlimited));
  });
}

namespace {

/// A convex polygon with few corners; clipping by a line adds at most one.
struct Polygon {
  std::array<Eigen::Vector2d, 12> corners;
  std::size_t count = 0;

  double area() const {
    double twice = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2d& a = corners[i];
      const Eigen::Vector2d& b = corners[i + 1 == count ? 0 : i + 1];
      twice += a.x() * b.y() - b.x() * a.y();
    }
    return 0.5 * std::abs(twice);
  }

  /// The part of it with sign * coordinate >= sign * border.
  Polygon beyond(int axis, double border, double sign) const {
    Polygon kept;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector2d& a = corners[i];
      const Eigen::Vector2d& b = corners[i + 1 == count ? 0 : i + 1];
      const double from = sign * (a[axis] - border), to = sign * (b[axis] - border);
      if (from >= 0.0) kept.corners[kept.count++] = a;
      if ((from < 0.0) != (to < 0.0)) kept.corners[kept.count++] = a + from / (from - to) * (b - a);
    }
    return kept;
  }
};

/// The plate in its own coordinates, in squares, the first inner corner at (0, 0).
struct Plate {
  Eigen::Array2d last;  ///< the outer border of the squares, which begin at -1
  double margin;        ///< white margin around them

  explicit Plate(const Chessboard& board) : last(board.inner_columns, board.inner_rows), margin(board.border_squares) {}

  bool is_black(int column, int row) const {
    return column >= -1 && row >= -1 && column < last.x() && row < last.y() && (column + row) % 2 == 0;
  }

  /// For a parallelogram with middle p and sides du, dv: the fractions of its area that are on the plate and that are
  /// black.
  struct Parts {
    double plate, black;
  };
  Parts parts_of(const Eigen::Array2d& p, const Eigen::Array2d& du, const Eigen::Array2d& dv) const {
    const Eigen::Array2d reach = 0.5 * (du.abs() + dv.abs());
    const Eigen::Array2d low = p - reach, high = p + reach;
    if ((high <= -1.0 - margin).any() || (low >= last + margin).any()) return {0.0, 0.0};
    const bool whole = (low >= -1.0 - margin).all() && (high <= last + margin).all();
    const Eigen::Array2i first = low.max(-1.0).floor().cast<int>(), end = high.min(last).ceil().cast<int>();
    if (whole && (end - first <= 1).all()) {  // within one square, or outside them all
      const bool beside = (high <= -1.0).any() || (low >= last).any();
      const bool inside = (low >= -1.0).all() && (high <= last).all();
      if (beside || inside) return {1.0, !beside && is_black(first.x(), first.y()) ? 1.0 : 0.0};
    }
    Polygon pixel;
    pixel.count = 4;
    pixel.corners[0] = p - 0.5 * du - 0.5 * dv;
    pixel.corners[1] = p + 0.5 * du - 0.5 * dv;
    pixel.corners[2] = p + 0.5 * du + 0.5 * dv;
    pixel.corners[3] = p - 0.5 * du + 0.5 * dv;
    const double area = pixel.area();
    double on_plate = area, black = 0.0;
    if (!whole) {
      const Polygon seen = pixel.beyond(0, -1.0 - margin, 1.0)
                               .beyond(0, last.x() + margin, -1.0)
                               .beyond(1, -1.0 - margin, 1.0)
                               .beyond(1, last.y() + margin, -1.0);
      on_plate = seen.area();
    }
    for (int column = first.x(); column < end.x(); ++column) {
      const Polygon strip = pixel.beyond(0, column, 1.0).beyond(0, column + 1.0, -1.0);
      for (int row = first.y(); row < end.y(); ++row) {
        if (is_black(column, row)) black += strip.beyond(1, row, 1.0).beyond(1, row + 1.0, -1.0).area();
      }
    }
    return {on_plate / area, black / area};
  }
};

}  // namespace

FloatImage paint_board(const Camera& camera, const RayTable& rays, const FloatImage& empty, const StaticScene& scene,
                       double white) {
  assert(stands_free(camera, scene));
  const Chessboard& board = *scene.board;
  const Plate plate(board);
  // A ray d (camera frame) meets the board's plane at t d = R (X, Y) + o: t^-1 (X, Y, 1) = [r1 r2 o]^-1 d.
  const Eigen::Isometry3d X_CP = camera.X_WC.inverse() * board.X_WP;
  Eigen::Matrix3d plane;
  plane << X_CP.linear().col(0) * board.square_m, X_CP.linear().col(1) * board.square_m, X_CP.translation();
  const Eigen::Matrix3d to_board = plane.inverse();
  const double shade = white * shade_of(-board.X_WP.linear().col(2));
  const Eigen::Vector3d x_W = board.square_m * board.X_WP.linear().col(0);
  const Eigen::Vector3d y_W = board.square_m * board.X_WP.linear().col(1);
  FloatImage image = empty;
  const PixelRect rect = pixels_before(camera, scene, 0);
  for (int v = rect.y; v < rect.y + rect.height; ++v) {
    const std::size_t start = static_cast<std::size_t>(v) * rays.width;
    for (int u = rect.x; u < rect.x + rect.width; ++u) {
      const std::size_t at = start + static_cast<std::size_t>(u);
      const Eigen::Array4d ray = Eigen::Map<const Eigen::Array4f>(&rays.x_y_dxdu_dxdv[4 * at]).cast<double>();
      const Eigen::Array2d slope = Eigen::Map<const Eigen::Array2f>(&rays.dydu_dydv[2 * at]).cast<double>();
      const Eigen::Vector3d h = to_board * Eigen::Vector3d(ray[0], ray[1], 1.0);
      if (!(h.z() > 0.0)) continue;
      const Eigen::Array2d p = h.head<2>() / h.z();
      const auto side = [&](double dx, double dy) -> Eigen::Array2d {
        const Eigen::Vector3d along = to_board.leftCols<2>() * Eigen::Vector2d(dx, dy);
        return (along.head<2>().array() - p * along.z()) / h.z();
      };
      const Plate::Parts parts = plate.parts_of(p, side(ray[2], slope[0]), side(ray[3], slope[1]));
      if (parts.plate == 0.0) continue;
      const Eigen::Vector3d p_W = board.X_WP.translation() + p.x() * x_W + p.y() * y_W;
      const double albedo = board.white_albedo * (parts.plate - parts.black) + board.black_albedo * parts.black;
      double value = albedo * shade * light_at(scene, p_W);
      if (!rays.gain.empty()) value *= static_cast<double>(rays.gain[at]);
      float& pixel = image.values[at];
      pixel = static_cast<float>(value + (1.0 - parts.plate) * static_cast<double>(pixel));
    }
  }
  return image;
}

}  // namespace glidelab::render
