#include "render/paint/sphere_image.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <numbers>

namespace glidelab::render {
namespace {

// Gauss-Legendre on [0, 1] with 8 points: exact up to degree 15. Nodes and weights of [-1, 1] from Abramowitz and
// Stegun, table 25.4.
constexpr std::array<double, 4> kNodes = {0.183434642495649805, 0.525532409916328986, 0.796666477413626740,
                                          0.960289856497536232};
constexpr std::array<double, 4> kWeights = {0.362683783378361983, 0.313706645877887287, 0.222381034453374471,
                                            0.101228536290376259};
constexpr int kAngles = 64;

}  // namespace

std::optional<Ellipse> image_of_sphere(const Eigen::Vector3d& center_C, double radius_m) {
  const double distance2 = center_C.squaredNorm();
  if (!(center_C.z() > radius_m)) return std::nullopt;
  // d^T A d <= 0 inside, with d = (x, y, 1).
  const Eigen::Matrix3d conic =
      (distance2 - radius_m * radius_m) * Eigen::Matrix3d::Identity() - center_C * center_C.transpose();
  const Eigen::Matrix2d quadratic = conic.topLeftCorner<2, 2>();
  const Eigen::Vector2d linear = conic.topRightCorner<2, 1>();
  Ellipse ellipse;
  ellipse.center = -quadratic.inverse() * linear;
  // Value at the centre: det(A) / det(quadratic); written out it is -r² (|c|² - r²)² / det without cancellation.
  const double inside = distance2 - radius_m * radius_m;
  const double at_center = -radius_m * radius_m * inside * inside / quadratic.determinant();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(quadratic);
  ellipse.axis_u = axes.eigenvectors().col(0) * std::sqrt(-at_center / axes.eigenvalues()(0));
  ellipse.axis_v = axes.eigenvectors().col(1) * std::sqrt(-at_center / axes.eigenvalues()(1));
  return ellipse;
}

AreaMoments image_of(const Camera& camera, const Ellipse& ellipse) {
  AreaMoments moments;
  const double ellipse_jacobian =
      std::abs(ellipse.axis_u.x() * ellipse.axis_v.y() - ellipse.axis_u.y() * ellipse.axis_v.x());
  for (std::size_t i = 0; i < kNodes.size() * 2; ++i) {
    const std::size_t node = i / 2;
    const double radius = 0.5 * (1.0 + (i % 2 == 0 ? kNodes[node] : -kNodes[node]));
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kAngles;
      const Eigen::Vector2d at =
          ellipse.center + radius * (std::cos(angle) * ellipse.axis_u + std::sin(angle) * ellipse.axis_v);
      const double weight = 0.5 * kWeights[node] * radius * (2.0 * std::numbers::pi / kAngles) * ellipse_jacobian *
                            distortion_jacobian(camera.lens, at).determinant() * camera.focal_px.prod();
      moments.area_px += weight;
      moments.centroid_px += weight * (distort(camera.lens, at).cwiseProduct(camera.focal_px) + camera.center_px);
    }
  }
  moments.centroid_px /= moments.area_px;
  return moments;
}

}  // namespace glidelab::render
