#include "core/pixel_edge.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidelab::core {
namespace {

constexpr double kNarrow = 0.1;  // pixels
constexpr double kFar = 6.0;     // standard deviations: Phi(-6) = 1e-9

/// Phi and the integrals of Phi(t / blur).
struct Primitive {
  double phi;     // density times blur
  double normal;  // Phi
  double first;   // K = t Phi + blur phi
  double second;  // H
};

Primitive primitive(double t, double blur) {
  const double z = t / blur;
  if (z > kFar) return {0.0, 1.0, t, 0.5 * (t * t + blur * blur)};
  if (z < -kFar) return {0.0, 0.0, 0.0, 0.0};
  Primitive p;
  p.phi = std::exp(-0.5 * z * z) * (1.0 / std::sqrt(2.0 * std::numbers::pi));
  p.normal = 0.5 * std::erfc(-z * (1.0 / std::numbers::sqrt2));
  p.first = t * p.normal + blur * p.phi;
  p.second = 0.5 * (t * p.first + blur * blur * p.normal);
  return p;
}

}  // namespace

PixelEdge pixel_edge(double s, double nu, double nv, double blur) {
  const double a = std::max(std::abs(nu), std::abs(nv));
  const double b = std::min(std::abs(nu), std::abs(nv));
  if (b < kNarrow) {
    const double joint = std::sqrt(blur * blur + b * b / 12.0);
    const Primitive right = primitive(s + 0.5 * a, joint);
    const Primitive left = primitive(s - 0.5 * a, joint);
    return {(right.first - left.first) / a, (right.normal - left.normal) / a, (right.phi - left.phi) / (joint * a)};
  }
  const Primitive p1 = primitive(s + 0.5 * (a + b), blur);
  const Primitive p2 = primitive(s + 0.5 * (a - b), blur);
  const Primitive p3 = primitive(s - 0.5 * (a - b), blur);
  const Primitive p4 = primitive(s - 0.5 * (a + b), blur);
  const double scale = 1.0 / (a * b);
  return {(p1.second - p2.second - p3.second + p4.second) * scale, (p1.first - p2.first - p3.first + p4.first) * scale,
          (p1.normal - p2.normal - p3.normal + p4.normal) * scale};
}

}  // namespace glidelab::core
