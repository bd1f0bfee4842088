#include "render/camera.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace glidelab::render {
namespace {

/// 1 + k1 s + k2 s² + k3 s³ with s = r².
double radial_factor(const BrownConrady& lens, double s) {
  return 1.0 + s * (lens.k1 + s * (lens.k2 + s * lens.k3));
}

/// d/dr of r times the radial factor, as a function of s = r².
double radial_slope(const BrownConrady& lens, double s) {
  return 1.0 + s * (3.0 * lens.k1 + s * (5.0 * lens.k2 + s * 7.0 * lens.k3));
}

/// The smallest positive zero of radial_slope(s), infinity where there is none. Between its stationary points the cubic
/// is monotonic, so that one sign change brackets one zero.
double first_zero_of_slope(const BrownConrady& lens) {
  const double a = 3.0 * lens.k1;
  const double b = 5.0 * lens.k2;
  const double c = 7.0 * lens.k3;
  // Stationary points: a + 2 b s + 3 c s² = 0.
  double stops[3] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), 0.0};
  if (c != 0.0) {
    const double under_root = b * b - 3.0 * a * c;
    if (under_root >= 0.0) {
      const double root = std::sqrt(under_root);
      stops[0] = (-b - root) / (3.0 * c);
      stops[1] = (-b + root) / (3.0 * c);
    }
  } else if (b != 0.0) {
    stops[0] = -a / (2.0 * b);
  }
  if (stops[0] > stops[1]) std::swap(stops[0], stops[1]);
  double low = 0.0;  // the slope is 1 there
  for (int piece = 0; piece < 3; ++piece) {
    double high = piece < 2 ? stops[piece] : std::numeric_limits<double>::infinity();
    if (!(high > low)) continue;
    if (std::isinf(high)) {
      // The sign at infinity is the leading coefficient's.
      const double lead = c != 0.0 ? c : (b != 0.0 ? b : a);
      if (!(lead < 0.0)) return std::numeric_limits<double>::infinity();
      high = std::max(1.0, 2.0 * low);
      while (radial_slope(lens, high) > 0.0) high *= 2.0;
    }
    if (radial_slope(lens, high) <= 0.0) {
      for (int i = 0; i < 200 && high - low > 1e-15 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (radial_slope(lens, middle) > 0.0 ? low : high) = middle;
      }
      return low;
    }
    low = high;
  }
  return std::numeric_limits<double>::infinity();
}

std::optional<Eigen::Vector2d> newton_inverse(const BrownConrady& lens, const Eigen::Vector2d& distorted,
                                              Eigen::Vector2d start, double largest_radius) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector2d miss = distort(lens, start) - distorted;
    const Eigen::Matrix2d jacobian = distortion_jacobian(lens, start);
    if (!(jacobian.determinant() > 0.0)) return std::nullopt;
    const Eigen::Vector2d step = jacobian.inverse() * miss;
    start -= step;
    if (!start.allFinite()) return std::nullopt;
    if (step.norm() <= 1e-15 * (1.0 + start.norm())) {
      if (start.norm() >= largest_radius || !(distortion_jacobian(lens, start).determinant() > 0.0)) {
        return std::nullopt;
      }
      if ((distort(lens, start) - distorted).norm() > 1e-14 * (1.0 + distorted.norm())) return std::nullopt;
      return start;
    }
  }
  return std::nullopt;
}

}  // namespace

Eigen::Vector2d distort(const BrownConrady& lens, const Eigen::Vector2d& undistorted) {
  const double x = undistorted.x();
  const double y = undistorted.y();
  const double s = x * x + y * y;
  const double radial = radial_factor(lens, s);
  return {x * radial + 2.0 * lens.p1 * x * y + lens.p2 * (s + 2.0 * x * x),
          y * radial + lens.p1 * (s + 2.0 * y * y) + 2.0 * lens.p2 * x * y};
}

Eigen::Matrix2d distortion_jacobian(const BrownConrady& lens, const Eigen::Vector2d& undistorted) {
  const double x = undistorted.x();
  const double y = undistorted.y();
  const double s = x * x + y * y;
  const double radial = radial_factor(lens, s);
  const double slope = lens.k1 + s * (2.0 * lens.k2 + s * 3.0 * lens.k3);  // d radial / d s
  Eigen::Matrix2d jacobian;
  jacobian(0, 0) = radial + 2.0 * x * x * slope + 2.0 * lens.p1 * y + 6.0 * lens.p2 * x;
  jacobian(0, 1) = 2.0 * x * y * slope + 2.0 * lens.p1 * x + 2.0 * lens.p2 * y;
  jacobian(1, 0) = jacobian(0, 1);
  jacobian(1, 1) = radial + 2.0 * y * y * slope + 6.0 * lens.p1 * y + 2.0 * lens.p2 * x;
  return jacobian;
}

double fold_radius(const BrownConrady& lens) {
  return std::sqrt(first_zero_of_slope(lens));
}

std::optional<Eigen::Vector2d> undistort(const BrownConrady& lens, const Eigen::Vector2d& distorted) {
  return undistort(lens, distorted, fold_radius(lens));
}

std::optional<Eigen::Vector2d> undistort(const BrownConrady& lens, const Eigen::Vector2d& distorted,
                                         double largest_radius) {
  if (const auto direct = newton_inverse(lens, distorted, distorted, largest_radius)) return direct;
  // Far from the axis Newton may start too far off: walk out from the centre in steps.
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  constexpr int kSteps = 64;
  for (int i = 1; i <= kSteps; ++i) {
    const auto next = newton_inverse(lens, distorted * (static_cast<double>(i) / kSteps), at, largest_radius);
    if (!next) return std::nullopt;
    at = *next;
  }
  return at;
}

std::optional<Eigen::Vector2d> undistorted_at(const Camera& camera, const Eigen::Vector2d& pixel) {
  return undistort(camera.lens, (pixel - camera.center_px).cwiseQuotient(camera.focal_px));
}

std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted) {
  return pixel_of(camera, undistorted, fold_radius(camera.lens));
}

std::optional<Eigen::Vector2d> pixel_of(const Camera& camera, const Eigen::Vector2d& undistorted,
                                        double largest_radius) {
  if (!(undistorted.norm() < largest_radius)) return std::nullopt;
  return Eigen::Vector2d(distort(camera.lens, undistorted).cwiseProduct(camera.focal_px) + camera.center_px);
}

std::optional<Eigen::Vector2d> project(const Camera& camera, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_C = camera.X_WC.inverse() * p_W;
  if (!(p_C.z() > 0.0)) return std::nullopt;
  return pixel_of(camera, p_C.head<2>() / p_C.z());
}

bool in_picture(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px) {
  return pixel.x() >= margin_px && pixel.y() >= margin_px && pixel.x() <= camera.width_px - 1 - margin_px &&
         pixel.y() <= camera.height_px - 1 - margin_px;
}

Eigen::Isometry3d look_at(const Eigen::Vector3d& position_W, const Eigen::Vector3d& target_W, double roll_rad) {
  const Eigen::Vector3d forward = (target_W - position_W).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitY()).normalized();
  const Eigen::Vector3d down = forward.cross(right);
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear().col(0) = std::cos(roll_rad) * right + std::sin(roll_rad) * down;
  X_WC.linear().col(1) = -std::sin(roll_rad) * right + std::cos(roll_rad) * down;
  X_WC.linear().col(2) = forward;
  X_WC.translation() = position_W;
  return X_WC;
}

std::optional<std::string> why_not_one_to_one(const Camera& camera) {
  const double largest_radius = fold_radius(camera.lens);
  const auto check = [&](double u, double v) {
    const Eigen::Vector2d distorted = (Eigen::Vector2d(u, v) - camera.center_px).cwiseQuotient(camera.focal_px);
    return undistort(camera.lens, distorted, largest_radius).has_value();
  };
  const double right = camera.width_px - 0.5;
  const double bottom = camera.height_px - 0.5;
  const int columns = (camera.width_px + 15) / 16;
  const int rows = (camera.height_px + 15) / 16;
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      const double u = -0.5 + (right + 0.5) * column / columns;
      const double v = -0.5 + (bottom + 0.5) * row / rows;
      if (!check(u, v)) {
        return fmt::format(
            "a lens that folds the picture over (no ray leads to the pixel ({:.1f}, {:.1f}); the radial "
            "part grows only up to {:.4g} focal lengths off the axis)",
            u, v, largest_radius);
      }
    }
  }
  for (int i = 0; i < camera.width_px; ++i) {
    if (!check(i, -0.5) || !check(i, bottom)) {
      return fmt::format("a lens that folds the picture over at column {} of its border", i);
    }
  }
  for (int i = 0; i < camera.height_px; ++i) {
    if (!check(-0.5, i) || !check(right, i)) {
      return fmt::format("a lens that folds the picture over at row {} of its border", i);
    }
  }
  return std::nullopt;
}

}  // namespace glidelab::render
