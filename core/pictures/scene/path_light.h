/// Light along the path of a marker, from the brightness of its own image in each frame: a shadow's edge that it
/// crosses, a gradient.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace glidelab::core {

/// A frame with the marker.
struct LitPoint {
  std::size_t frame = 0;
  double x_m = 0.0;
  double level = 0.0;  ///< brightness, above 0, in any unit
};

/// A place at which the brightness changes within one diameter.
struct LightEdge {
  double x_m = 0.0;
  double fall = 0.0;                            ///< part of the brighter side that is lost on the darker one
  bool downhill = false;                        ///< whether the darker side has the larger x
  std::size_t first_frame = 0, last_frame = 0;  ///< in which the marker lies across it
};

/// The edges that a marker of a diameter crosses, in the order of the frames: one for each crossing.
///
/// A frame's change is the mean of ln(level) over the frames from half a diameter to one and a half beyond it, minus
/// that of those before it in the same pass (a pass ends where the marker turns). An edge is the largest change within
/// a diameter either way, of 10 % or more, five times the usual one (1.48 times the median size of the differences from
/// the median change, which is that of a gradient).
std::vector<LightEdge> edges_of_light(const std::vector<LitPoint>& points, double diameter_m);

/// d ln(level) / dx in the middle of the path.
struct LightSlope {
  double per_m = 0.0, sd_per_m = 0.0;
};

/// Least squares of ln(level) = a + g x + q x² with one g and q, and an a for each clip, about the middle of all x. At
/// each of `edges` the level has a step of its own, smoothed over a diameter. For the standard deviation a
/// diameter of the path counts once, in all clips together: they pass the same surfaces. Empty for fewer than 40
/// points, a path of less than two diameters, or where brightness rises and falls again (q exceeds g over half of the
/// path).
std::optional<LightSlope> slope_of_light(const std::vector<std::vector<LitPoint>>& clips,
                                         const std::vector<double>& edges_m, double diameter_m);

/// How far the centroid of a uniform disc of radius r lies from its centre where the light changes by g per length: the
/// second moment of its area along one direction is r²/4.
constexpr double displacement_by_slope(double slope, double radius) {
  return 0.25 * radius * radius * slope;
}

}  // namespace glidelab::core
