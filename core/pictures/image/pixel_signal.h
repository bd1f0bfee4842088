/// The signal of a pixel: the light that it receives from a straight edge that a lens has blurred, and its noise.
///
/// An ideal edge, bright where s > 0, is convolved with a Gaussian of standard deviation `blur` and averaged over the
/// pixel's square of side 1. Along the edge's normal n the square is two boxes of widths a = |n_u| and b = |n_v|, so
/// that
///
///     E(s) = [H(s + (a+b)/2) - H(s + (a-b)/2) - H(s - (a-b)/2) + H(s - (a+b)/2)] / (a b),
///     H(t) = ((t^2 + blur^2) Phi(t / blur) + t blur phi(t / blur)) / 2,      H'' = Phi(t / blur)
///
/// exact for straight edges. Where the smaller of a and b is below 0.1, its box is taken as a Gaussian of the same
/// variance (b^2 / 12), which changes E by less than 1e-6.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>

namespace glidelab::core {

struct PixelEdge {
  double value;  ///< E, from 0 to 1
  double slope;  ///< dE / ds
  double bend;   ///< d2E / ds2; dE / d(blur) = blur * bend
};

/// `s` distance of the pixel's centre inside the edge, (nu, nv) the edge's unit normal, lengths in pixels; blur > 0.
PixelEdge pixel_edge(double s, double nu, double nv, double blur);

// The same formula without a branch and in steps, for one pixel or, in a loop, for many at once.

inline constexpr double kNarrowPixel = 0.1;  // pixels
inline constexpr double kFarFromEdge = 6.0;  // standard deviations: Phi(-6) = 1e-9
inline constexpr int kNormalNodesPerUnit = 64;

/// Density and distribution of the standard normal at nodes from -kFarFromEdge to kFarFromEdge; at both ends 0 and 0,
/// 0 and 1.
struct NormalNodes {
  static constexpr int kCount = 2 * static_cast<int>(kFarFromEdge) * kNormalNodesPerUnit + 1;
  std::array<double, kCount> density, distribution;
};
NormalNodes make_normal_nodes();

/// Phi and the integrals of Phi(t / blur).
struct EdgePrimitive {
  double phi;     // density times blur
  double normal;  // Phi
  double first;   // K = t Phi + blur phi
  double second;  // H
};

/// phi(z) = phi(z0) e^q with q = -z0 d - d^2/2, and Phi(z) by its Taylor series, from the nearest node z0 = z - d: |d|
/// is at most 1/128 and |q| 0.047, so that the truncation error is below 2e-11 of phi, and 1e-15 of 1 in Phi.
[[gnu::always_inline]] inline EdgePrimitive edge_primitive(const NormalNodes& nodes, double t, double blur,
                                                           double per_blur) {
  const double at = t * per_blur, not_below = at > -kFarFromEdge ? at : -kFarFromEdge;  // nor a NaN
  const double z = not_below < kFarFromEdge ? not_below : kFarFromEdge;
  const auto nearest = static_cast<std::int32_t>((z + kFarFromEdge) * kNormalNodesPerUnit + 0.5);
  const double z0 = static_cast<double>(nearest) * (1.0 / kNormalNodesPerUnit) - kFarFromEdge, d = z - z0;
  const double density = nodes.density[static_cast<std::size_t>(nearest)];
  constexpr double k3 = 1.0 / 6.0, k4 = 1.0 / 24.0, k5 = 1.0 / 120.0;
  const double q = -d * (z0 + 0.5 * d), q2 = q * q;
  const double power = (1.0 + q) + q2 * ((0.5 + q * k3) + q2 * (k4 + q * k5));
  // The derivatives of phi are phi times -He1, He2, -He3, He4: Hermite's polynomials of z0.
  const double square = z0 * z0, he2 = square - 1.0, he3 = z0 * (square - 3.0), he4 = square * (square - 6.0) + 3.0;
  const double d2 = d * d;
  const double rise = d * ((1.0 - 0.5 * d * z0) + d2 * ((k3 * he2 - k4 * d * he3) + k5 * d2 * he4));
  EdgePrimitive p;
  p.phi = density * power;
  p.normal = nodes.distribution[static_cast<std::size_t>(nearest)] + density * rise;
  p.first = t * p.normal + blur * p.phi;
  p.second = 0.5 * (t * p.first + blur * blur * p.normal);
  return p;
}

/// A pixel's square as the edge sees it: the widths of its two boxes, the narrower one 0 where it is taken as a
/// Gaussian.
struct EdgeBoxes {
  double wide, other;
  double blur, per_blur;  // of the edge, with the narrow box
  double scale;
  double narrow;  // 1 where it is, else 0
};

// What follows is in steps, and each step computes all of both cases, because vectors have no branches.

[[gnu::always_inline]] inline EdgeBoxes edge_boxes(double nu, double nv, double blur) {
  const double along_u = std::abs(nu), along_v = std::abs(nv);
  const double wide = along_u > along_v ? along_u : along_v, least = along_u > along_v ? along_v : along_u;
  const double narrow = least < kNarrowPixel ? 1.0 : 0.0;
  const double joint = std::sqrt(blur * blur + narrow * (least * least * (1.0 / 12.0)));
  const double other = (1.0 - narrow) * least;
  return {wide, other, joint, 1.0 / joint, 1.0 / (wide * (other + narrow)), narrow};
}

/// The primitives at the four corners of the trapezoid that the boxes make.
struct EdgeCorners {
  EdgePrimitive p1, p2, p3, p4;
};

[[gnu::always_inline]] inline EdgeCorners edge_corners(const NormalNodes& nodes, double s, const EdgeBoxes& boxes) {
  const double outer = 0.5 * (boxes.wide + boxes.other), inner = 0.5 * (boxes.wide - boxes.other);
  return {edge_primitive(nodes, s + outer, boxes.blur, boxes.per_blur),
          edge_primitive(nodes, s + inner, boxes.blur, boxes.per_blur),
          edge_primitive(nodes, s - inner, boxes.blur, boxes.per_blur),
          edge_primitive(nodes, s - outer, boxes.blur, boxes.per_blur)};
}

[[gnu::always_inline]] inline PixelEdge edge_of(const EdgeBoxes& boxes, const EdgeCorners& at) {
  const auto& [p1, p2, p3, p4] = at;
  // The second differences are 0 where the other box has no width.
  const double value = (p1.second - p2.second - p3.second + p4.second) + boxes.narrow * (p1.first - p4.first);
  const double slope = (p1.first - p2.first - p3.first + p4.first) + boxes.narrow * (p1.normal - p4.normal);
  const double bend =
      (p1.normal - p2.normal - p3.normal + p4.normal) + boxes.narrow * (p1.phi - p4.phi) * boxes.per_blur;
  return {value * boxes.scale, slope * boxes.scale, bend * boxes.scale};
}

/// The noise of the pixels of an image of floats: the standard deviation of one pixel, from second differences along
/// the rows, whose median is not moved by edges.
double noise_of(const cv::Mat& values);

/// The same of the image shrunk by a whole number, from some of its rows; values of 8 or 16 bits.
double noise_when_shrunk(const cv::Mat& values, int shrink);

/// From an image's codes to light and back: straight, or by the curve of video and photographs (IEC 61966-2-1, sRGB).
enum class ToneCurve { linear, srgb };

/// Light of a code and back, both as shares of the largest; beyond 0 and 1 clipped, as a camera does.
double light_of_code(ToneCurve tone, double code);
double code_of_light(ToneCurve tone, double light);

}  // namespace glidelab::core
