/// How much of each pixel in a row of a tile lies within an outline.
///
/// All eight pixels of a row are processed together, so that a compiler turns the arithmetic into vector instructions.
/// If the processor has AVX2 these are wider, with the same operations: the results are the same to the last bit.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

#include "render/camera/optics.h"
#include "render/random/random_numbers.h"

namespace glidelab::render {

using TileRow = std::array<double, kRayTile>;

/// The rays of the pixels and their slopes; a row of fewer than kRayTile pixels is padded with its last one.
struct RowRays {
  TileRow x, y, dxdu, dxdv, dydu, dydv;
};

/// Rays of the pixels (x, y) to (x + count - 1, y), all in one tile.
RowRays rays_of_row(const RayTable& rays, int x, int y, int count);

/// Coverage by the region on the inner side of all lines a x + b y + c > 0 (at most four).
TileRow polygon_row(std::span<const Eigen::Vector3d> lines, const RowRays& rays, Simd simd = Simd::best);

/// Coverage by a sphere's image, each pixel in quarters, the outline's curvature to first order.
TileRow sphere_row(const Eigen::Vector3d& center_C, double radius_m, const RowRays& rays, Simd simd = Simd::best);

/// How much of a pixel lies within straight outlines; exact.
///
/// A line is given in the pixel's own coordinates, |x|, |y| <= 1/2: its inner side is where s + gx x + gy y > 0.
struct PixelLine {
  double s = 0.0;
  double gx = 0.0;
  double gy = 0.0;
};

/// The fraction of the pixel on the inner side of all lines (up to eight): the pixel's square is clipped by one line
/// after another (Sutherland and Hodgman), and the remaining area is computed.
double convex_coverage(std::span<const PixelLine> lines);

}  // namespace glidelab::render
