/// The smoothed points of free stretches that count for a line, and what a line is fitted to.
///
/// Every stretch is smoothed with its own points alone. Within kKernelMargin bandwidths of its first or last point the
/// kernel is not complete there; what that costs, and why these points are left out: with c the distance in bandwidths,
/// the variance of a is 1.64 (c = 2.5), 1.17 (c = 3), 1.04 (c = 3.5) of what it is inside, and grows 500 times towards
/// c = 0; its bias is 0.78, 0.90 and 0.97 of the inner h^2 x''''/2.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/lines/line_fit.h"
#include "core/motion/smoothing/local_cubic.h"

namespace glidelab::core {

inline constexpr double kKernelMargin = 2.5;

/// Inside a stretch a kernel with a gap is left out where the variance of a exceeds that of a complete kernel by this.
inline constexpr double kGapVariance = 2.0;

struct StretchPoint {
  std::size_t point = 0;  ///< of the motion
  std::size_t stretch = 0;
  int direction = 0;
  LeftOut left_out = LeftOut::used;
  bool smoothed = false;
  SmoothedPoint x;               ///< x, v, a
  SmoothedPoint y;               ///< y, y', y'': without the known force
  std::optional<KernelRow> row;  ///< over the points of the motion
};

/// Which points a caller has a use for: where only those that may count are wanted, those at a stretch's ends are not
/// smoothed at all (each has a kernel of its own, which is most of the work).
enum class WantedPoints { all, inner };

/// Every `stride`-th point of every stretch; with `inner` without those in the margins and without whole stretches that
/// are left out.
std::vector<StretchPoint> smooth_stretches(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                           double bandwidth_s, std::size_t stride = 1,
                                           WantedPoints wanted = WantedPoints::all);

/// What an error of a by the law's own curvature over time would be: g(t) = f(v(t)) is what a without the force should
/// be at each point (0 where unknown), and the result is the smoothed minus the true g, by smoothing its double
/// integral as positions are smoothed. For v' = -k v + const it is (k h)^2 / 2 of a.
std::vector<double> smoothing_bias(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<double>& law_m_s2, const std::vector<StretchPoint>& points);

/// The used points of one direction; `bias` is that of smoothing_bias() for the same points. With a known force a is
/// y'', and one standard deviation of the mass changes it by F sd / m^2.
LineInput line_input(const Motion& motion, const std::vector<StretchPoint>& points, const std::vector<double>& bias,
                     int direction, double mass_kg, double mass_sd_kg);

/// What displacements of the track's positions (TrackData::shared_m) do to v and a of the input's points.
std::vector<std::vector<MotionShift>> calibration_shifts(const Motion& motion, const LineInput& input,
                                                         const std::vector<std::vector<double>>& shared_m);

}  // namespace glidelab::core
