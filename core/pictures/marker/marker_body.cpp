#include "core/pictures/marker/marker_body.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/math/dense.h"
#include "core/math/quantile.h"
#include "core/pictures/marker/sphere/sphere_window.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestOutlines = 16;
constexpr int kBodyRounds = 5;
constexpr double kUsualTimes = 3.0;      // the usual residual, beyond which an outline counts less
constexpr double kFarFromOther = 5.0;    // standard deviations
constexpr double kNearThisOne = 0.3;     // of the distance to the other
constexpr double kMostCorrelated = 0.9;  // from frame to frame
constexpr double kMostOfRidge = 0.01;    // part of what is known of b that may come from the ridge, not the outlines

using Terms = Eigen::Vector4d;  // b, k, and the two components of e

/// ln(long / short) (cos 2a, sin 2a).
Eigen::Vector2d deviator(const cv::Vec3d& shape) {
  const double mean = 0.5 * (shape[0] + shape[2]);
  const Eigen::Vector2d half(0.5 * (shape[0] - shape[2]), shape[1]);
  const double spread = half.norm();
  if (!(spread > 1e-12 * mean) || !(spread < mean)) return Eigen::Vector2d::Zero();
  return -half * (std::log((mean + spread) / (mean - spread)) / spread);
}

Eigen::Vector2d smear_of(const OutlineSeen& outline) {
  const cv::Point2d v = outline.motion_px / radius_of(outline.seen);
  return {v.x * v.x - v.y * v.y, 2.0 * v.x * v.y};
}

}  // namespace

std::optional<MarkerBody> body_by_outline(const std::vector<OutlineSeen>& outlines) {
  if (outlines.size() < kFewestOutlines) return std::nullopt;
  Terms terms = Terms::Zero();
  Eigen::Matrix4d inverse = Eigen::Matrix4d::Zero();
  std::vector<Eigen::Vector2d> residuals(outlines.size(), Eigen::Vector2d::Zero());
  double usual = 0.0;  // residual; 0: not known yet
  // A motion that leaves no smear, or a path along which no outline changes, determines nothing.
  const double ridge = 1e-9 * static_cast<double>(outlines.size());
  for (int round = 0; round < kBodyRounds; ++round) {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Terms gradient = Terms::Zero();
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      const Eigen::Vector2d disc = deviator(outlines[i].disc), smear = smear_of(outlines[i]);
      const Eigen::Vector2d apart = deviator(outlines[i].sphere) - disc;
      Eigen::Matrix<double, 2, 4> slope;
      slope << apart[0], smear[0], 1.0, 0.0, apart[1], smear[1], 0.0, 1.0;
      const double size = residuals[i].norm();
      const double weight = usual > 0.0 && size > kUsualTimes * usual ? kUsualTimes * usual / size : 1.0;
      information += weight * slope.transpose() * slope;
      gradient += weight * slope.transpose() * (deviator(outlines[i].seen) - disc);
    }
    information += ridge * Eigen::Matrix4d::Identity();
    terms = base::solve_positive(information, gradient);
    inverse = base::inverse_positive(information);
    if (!terms.allFinite()) return std::nullopt;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < outlines.size(); ++i) {
      const Eigen::Vector2d disc = deviator(outlines[i].disc), smear = smear_of(outlines[i]);
      const Eigen::Vector2d apart = deviator(outlines[i].sphere) - disc;
      residuals[i] =
          deviator(outlines[i].seen) - disc - terms[0] * apart - terms[1] * smear - Eigen::Vector2d(terms[2], terms[3]);
      sizes.push_back(residuals[i].norm());
    }
    usual = median_of(std::move(sizes));
  }
  if (ridge * inverse(0, 0) > kMostOfRidge) return std::nullopt;
  // Errors of neighbouring frames are alike where the marker is slow.
  double squares = 0.0, products = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    squares += residuals[i].squaredNorm();
    if (i > 0) products += residuals[i].dot(residuals[i - 1]);
  }
  const double correlated = squares > 0.0 ? std::clamp(products / squares, 0.0, kMostCorrelated) : 0.0;
  const double variance = 0.5 * squares / static_cast<double>(residuals.size());
  const double sd = std::sqrt(inverse(0, 0) * variance * (1.0 + correlated) / (1.0 - correlated));
  const double to_disc = std::abs(terms[0]), to_sphere = std::abs(1.0 - terms[0]);
  if (to_disc < kNearThisOne && to_sphere > kFarFromOther * sd) return MarkerBody::disc;
  if (to_sphere < kNearThisOne && to_disc > kFarFromOther * sd) return MarkerBody::sphere;
  return std::nullopt;
}

}  // namespace glidelab::core
