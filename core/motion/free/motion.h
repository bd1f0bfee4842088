/// The measured motion of one clip, the starting point of its analysis, and the outliers among its points.
#pragma once

#include <cstddef>
#include <vector>

#include "core/track/track_data.h"

namespace glidelab::core {

/// Points in order of time. `y_m` is the position minus the motion that the known force alone would cause,
///
///     y(t) = x(t) - integral integral F/m,   so that   y'' = a - F/m   is what gravity and friction do,
///
/// with F linear between its samples. Smoothing y as x is smoothed gives a and F/m the same kernel and so the same
/// bias. Without a force y is x.
struct Motion {
  std::vector<double> t_s;
  std::vector<double> x_m;
  std::vector<double> y_m;
  std::vector<std::size_t> point;  ///< index in the track
  double step_s = 0.0;             ///< median time step
  double noise_m = 0.0;            ///< standard deviation of one position, from its neighbours (pilot_noise)
  bool forced = false;
};

Motion motion_of(const TrackData& track, double mass_kg);

/// The same without the points of the given indices (rising).
Motion without(const Motion& motion, const std::vector<std::size_t>& points);

/// Single positions that lie off the motion, because something else was mistaken for the marker in one frame. Returns
/// the indices of points that are off the cubic through their ten nearest neighbours by more than six standard
/// deviations of that prediction, taken from the noise or from the neighbours' own scatter about the cubic, whichever
/// is larger. At a release or a jump the neighbours scatter as much as the point. At an impact, the motion before or
/// after runs smoothly into the point (the parabola of five neighbours on one side, within three standard deviations).
/// Nothing there is an outlier. Up to two of the neighbours may be outliers themselves. For normal noise one point in
/// 1e9 is taken by mistake.
std::vector<std::size_t> find_outliers(const Motion& motion);

}  // namespace glidelab::core
