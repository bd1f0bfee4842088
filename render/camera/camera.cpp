#include "render/camera/camera.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

namespace glidelab::render {
namespace {

/// The factor on the radius, and its derivative by s = r².
struct Radial {
  double factor;
  double slope;
};

Radial radial_of(const Lens& lens, double s) {
  const double factor = 1.0 + s * (lens.k1 + s * (lens.k2 + s * lens.k3));
  const double slope = lens.k1 + s * (2.0 * lens.k2 + s * 3.0 * lens.k3);
  if (lens.model == LensModel::brown_conrady) return {factor, slope};
  if (lens.model == LensModel::rational) {
    const double below = 1.0 + s * (lens.k4 + s * (lens.k5 + s * lens.k6));
    const double below_slope = lens.k4 + s * (2.0 * lens.k5 + s * 3.0 * lens.k6);
    return {factor / below, (slope * below - factor * below_slope) / (below * below)};
  }
  // Near the axis theta_d / r = 1 + (k1 - 1/3) s + (1/5 - k1 + k2) s² + …; the next term is 1e-18 at the limit.
  constexpr double kNearAxis = 1e-6;
  if (s < kNearAxis) {
    const double first = lens.k1 - 1.0 / 3.0;
    const double second = 0.2 - lens.k1 + lens.k2;
    return {1.0 + s * (first + s * second), first + 2.0 * s * second};
  }
  const double r = std::sqrt(s);
  const double theta = std::atan(r);
  const double q = theta * theta;
  const double bent = theta * (1.0 + q * (lens.k1 + q * (lens.k2 + q * (lens.k3 + q * lens.k4))));
  const double rise = 1.0 + q * (3.0 * lens.k1 + q * (5.0 * lens.k2 + q * (7.0 * lens.k3 + q * 9.0 * lens.k4)));
  return {bent / r, (rise / (1.0 + s) - bent / r) / (2.0 * s)};
}

std::optional<Eigen::Vector2d> newton_inverse(const Lens& lens, const Eigen::Vector2d& distorted, Eigen::Vector2d start,
                                              double largest_radius) {
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

/// theta from theta_d, by bisection and Newton's method between 0 and the angle at which the mapping folds or ends.
std::optional<Eigen::Vector2d> fisheye_inverse(const Lens& lens, const Eigen::Vector2d& distorted,
                                               double largest_radius) {
  const double wanted = distorted.norm();
  if (wanted == 0.0) return distorted;
  const auto bent = [&](double theta) {
    const double q = theta * theta;
    return theta * (1.0 + q * (lens.k1 + q * (lens.k2 + q * (lens.k3 + q * lens.k4))));
  };
  double low = 0.0;
  double high = std::isinf(largest_radius) ? 0.5 * std::numbers::pi : std::atan(largest_radius);
  if (!(bent(high) > wanted)) return std::nullopt;
  double theta = std::min(wanted, 0.999 * high);
  for (int i = 0; i < 100; ++i) {
    const double miss = bent(theta) - wanted;
    (miss > 0.0 ? high : low) = theta;
    const double q = theta * theta;
    const double rise = 1.0 + q * (3.0 * lens.k1 + q * (5.0 * lens.k2 + q * (7.0 * lens.k3 + q * 9.0 * lens.k4)));
    double next = theta - miss / rise;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - theta) <= 1e-16 * (1.0 + theta)) break;
    theta = next;
  }
  const double radius = std::tan(theta);
  if (!(radius < largest_radius)) return std::nullopt;
  return Eigen::Vector2d(distorted * (radius / wanted));
}

using Polynomial = std::vector<double>;  // coefficients, the constant first

double value(const Polynomial& p, double s) {
  double sum = 0.0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * s + p[i];
  return sum;
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial out(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
  }
  return out;
}

/// s times the derivative.
Polynomial turned(const Polynomial& p) {
  Polynomial out = p;
  for (std::size_t i = 0; i < p.size(); ++i) out[i] = static_cast<double>(i) * p[i];
  return out;
}

Polynomial sum(const Polynomial& a, double factor, const Polynomial& b) {
  Polynomial out(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) out[i] += a[i];
  for (std::size_t i = 0; i < b.size(); ++i) out[i] += factor * b[i];
  return out;
}

/// The positive real zeros, rising: eigenvalues of the companion matrix, which already has Hessenberg form.
std::vector<double> positive_zeros(Polynomial p) {
  while (!p.empty() && p.back() == 0.0) p.pop_back();
  if (p.size() < 2) return {};
  const auto degree = static_cast<Eigen::Index>(p.size() - 1);
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  for (Eigen::Index i = 0; i < degree; ++i) {
    companion(i, degree - 1) = -p[static_cast<std::size_t>(i)] / p.back();
    if (i > 0) companion(i, i - 1) = 1.0;
  }
  constexpr double kReal = 1e-6;  // a double zero splits by the square root of the rounding error
  std::vector<double> zeros;
  Eigen::RealSchur<Eigen::MatrixXd> schur(degree);
  schur.computeFromHessenberg(companion, Eigen::MatrixXd(), false);
  const Eigen::MatrixXd& t = schur.matrixT();
  const auto keep = [&](std::complex<double> z) {
    if (z.real() > 0.0 && std::abs(z.imag()) <= kReal * std::abs(z)) zeros.push_back(z.real());
  };
  for (Eigen::Index i = 0; i < degree; ++i) {
    if (i + 1 == degree || t(i + 1, i) == 0.0) {
      keep(t(i, i));
      continue;
    }
    // A remaining 2 x 2 block contains a conjugate pair.
    const double half = 0.5 * (t(i, i) - t(i + 1, i + 1));
    const std::complex<double> root = std::sqrt(std::complex<double>(half * half + t(i, i + 1) * t(i + 1, i)));
    const double middle = 0.5 * (t(i, i) + t(i + 1, i + 1));
    keep(middle + root);
    keep(middle - root);
    ++i;
  }
  std::sort(zeros.begin(), zeros.end());
  return zeros;
}

/// The smallest s > 0 at which a polynomial that is positive at 0 becomes negative; infinity if it does not. A zero
/// that it only touches does not count.
double first_crossing(const Polynomial& p) {
  const std::vector<double> zeros = positive_zeros(p);
  double low = 0.0;
  for (std::size_t i = 0; i < zeros.size(); ++i) {
    const double beyond = i + 1 < zeros.size() ? 0.5 * (zeros[i] + zeros[i + 1]) : 2.0 * zeros[i];
    if (value(p, beyond) > 0.0) {
      low = beyond;
      continue;
    }
    double high = beyond;
    for (int k = 0; k < 200 && high - low > 1e-15 * high; ++k) {
      const double middle = 0.5 * (low + high);
      (value(p, middle) > 0.0 ? low : high) = middle;
    }
    return low;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

const char* name_of(LensModel model) {
  switch (model) {
    case LensModel::rational:
      return "rational";
    case LensModel::fisheye:
      return "fisheye";
    default:
      return "brown-conrady";
  }
}

Eigen::Vector2d distort(const Lens& lens, const Eigen::Vector2d& undistorted) {
  const double x = undistorted.x();
  const double y = undistorted.y();
  const double s = x * x + y * y;
  const double radial = radial_of(lens, s).factor;
  return {x * radial + 2.0 * lens.p1 * x * y + lens.p2 * (s + 2.0 * x * x),
          y * radial + lens.p1 * (s + 2.0 * y * y) + 2.0 * lens.p2 * x * y};
}

Eigen::Matrix2d distortion_jacobian(const Lens& lens, const Eigen::Vector2d& undistorted) {
  const double x = undistorted.x();
  const double y = undistorted.y();
  const double s = x * x + y * y;
  const auto [radial, slope] = radial_of(lens, s);
  Eigen::Matrix2d jacobian;
  jacobian(0, 0) = radial + 2.0 * x * x * slope + 2.0 * lens.p1 * y + 6.0 * lens.p2 * x;
  jacobian(0, 1) = 2.0 * x * y * slope + 2.0 * lens.p1 * x + 2.0 * lens.p2 * y;
  jacobian(1, 0) = jacobian(0, 1);
  jacobian(1, 1) = radial + 2.0 * y * y * slope + 6.0 * lens.p1 * y + 2.0 * lens.p2 * x;
  return jacobian;
}

std::optional<Eigen::Vector2d> undistort(const Lens& lens, const Eigen::Vector2d& distorted) {
  return undistort(lens, distorted, fold_radius(lens));
}

std::optional<Eigen::Vector2d> undistort(const Lens& lens, const Eigen::Vector2d& distorted, double largest_radius) {
  if (lens.model == LensModel::fisheye) return fisheye_inverse(lens, distorted, largest_radius);
  if (const auto direct = newton_inverse(lens, distorted, distorted, largest_radius)) return direct;
  // Far from the axis Newton's method may start too far off, so it proceeds from the centre in steps.
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  constexpr int kSteps = 64;
  for (int i = 1; i <= kSteps; ++i) {
    const auto next = newton_inverse(lens, distorted * (static_cast<double>(i) / kSteps), at, largest_radius);
    if (!next) return std::nullopt;
    at = *next;
  }
  return at;
}

double fold_radius(const Lens& lens) {
  if (lens.model == LensModel::fisheye) {
    // d theta_d / d theta in q = theta².
    const double q = first_crossing({1.0, 3.0 * lens.k1, 5.0 * lens.k2, 7.0 * lens.k3, 9.0 * lens.k4});
    const double theta = std::sqrt(q);
    return theta < 0.5 * std::numbers::pi ? std::tan(theta) : std::numeric_limits<double>::infinity();
  }
  const Polynomial above{1.0, lens.k1, lens.k2, lens.k3};
  if (lens.model == LensModel::brown_conrady) {
    return std::sqrt(first_crossing(sum(above, 2.0, turned(above))));
  }
  // d(r N/D)/dr = ((N + 2 s N') D - 2 s N D') / D², s = r².
  const Polynomial below{1.0, lens.k4, lens.k5, lens.k6};
  const Polynomial slope = sum(product(sum(above, 2.0, turned(above)), below), -2.0, product(above, turned(below)));
  return std::sqrt(std::min(first_crossing(slope), first_crossing(below)));
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

bool in_image(const Camera& camera, const Eigen::Vector2d& pixel, double margin_px) {
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
            "a lens that folds the image over (no ray leads to the pixel ({:.1f}, {:.1f}); the mapping "
            "is one to one up to {:.4g} focal lengths off the axis)",
            u, v, largest_radius);
      }
    }
  }
  for (int i = 0; i < camera.width_px; ++i) {
    if (!check(i, -0.5) || !check(i, bottom)) {
      return fmt::format("a lens that folds the image over at column {} of its border", i);
    }
  }
  for (int i = 0; i < camera.height_px; ++i) {
    if (!check(-0.5, i) || !check(right, i)) {
      return fmt::format("a lens that folds the image over at row {} of its border", i);
    }
  }
  return std::nullopt;
}

Eigen::Isometry3d mount_at(const Mount& mount, double t_s) {
  std::array<double, 6> value{};
  for (const MountMotion& motion : mount.motions) {
    value[static_cast<std::size_t>(motion.axis)] +=
        motion.offset + motion.drift_per_s * t_s +
        motion.amplitude * std::sin(2.0 * std::numbers::pi * motion.frequency_hz * t_s + motion.phase_rad);
  }
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.translation() = Eigen::Vector3d(value[0], value[1], value[2]);
  moved.linear() =
      (Eigen::AngleAxisd(value[3], Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(value[4], Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(value[5], Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  return moved;
}

double image_shift_px(const Camera& camera, const Eigen::Isometry3d& moved) {
  double largest = 0.0;
  const double right = camera.width_px - 1.0;
  const double bottom = camera.height_px - 1.0;
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(0.5 * right, 0.5 * bottom), Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(right, 0.0),
        Eigen::Vector2d(0.0, bottom), Eigen::Vector2d(right, bottom)}) {
    const auto ray = undistorted_at(camera, pixel);
    if (!ray) continue;
    const Eigen::Vector3d there = moved * Eigen::Vector3d(ray->homogeneous());
    if (const auto shifted = pixel_of(camera, there.hnormalized())) {
      largest = std::max(largest, (*shifted - pixel).norm());
    }
  }
  return largest;
}

}  // namespace glidelab::render
