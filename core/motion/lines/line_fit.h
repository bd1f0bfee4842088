/// The line a = a0 - (K/m) v by ordinary least squares through the smoothed points of free stretches, as the paper fits
/// it, with the effect of the position noise on its coefficients.
///
/// Smoothed points are correlated over the kernel, so the textbook formula for independent points is wrong here. But v
/// and a are linear in the measured positions, and so, to first order in the noise n, are the coefficients:
///
///     d(K/m, a0) = (A'A)^-1 A' (da + (K/m) dv) = L n,     A_j = (-v_j, 1),     covariance = L Sigma L'
///
/// with Sigma the estimated autocovariance of the noise. The term that is left out, (dA)'(residual), is of second
/// order: it shrinks K/m by var(v noise) / var(v), which is below 1e-3 wherever the lines are worth fitting.
///
/// Where the points lie off the line by more than the noise explains (the law is no line, the track is not straight)
/// the covariance grows by that part of their scatter: the residuals are cut into eight or more blocks in time, never
/// across stretches, and
///
///     covariance += (1 - 1/X) (A'A)^-1 [ sum over blocks of s s' ] (A'A)^-1  n_b / (n_b - 2),   s = sum of A_j' e_j,
///
/// with X the mean square residual over that expected of the noise, where X is above 1 by more than chance allows
/// (chi2_ratio_limit of estimate.h).
///
/// An error of the camera or the plane displaces all positions by x_k(t), and so v by dv and a by da (the same sums
/// over the kernel); to first order the line changes by
///
///     d(K/m, a0) = (A'A)^-1 [A' (da + (K/m) dv) + (dA)' e],     (dA)' e = (- sum of dv_j e_j, 0).
///
/// Where there are four stretches or more, leaving them out one at a time (the jackknife) gives a covariance that needs
/// no noise model; it counts where it is the larger one by more than chance allows.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/result/results.h"

namespace glidelab::core {

struct MotionShift {
  double v_m_s = 0.0;
  double a_m_s2 = 0.0;
};

/// The points of one direction, and how they follow from the `track_points` measured positions.
struct LineInput {
  std::size_t track_points = 0;
  std::vector<double> t_s;                ///< of the measured positions
  bool forced = false;                    ///< a known force acts
  std::vector<double> noise_factor = {};  ///< of each measured position's noise (stretch_noise.h); empty: 1
  std::vector<double> v_m_s;
  std::vector<double> a_m_s2;          ///< with the known force's part F/m taken off
  std::vector<KernelRow> rows;         ///< over the measured positions
  std::vector<std::size_t> stretch;    ///< that each point belongs to; they follow each other
  std::vector<double> bias_a_m_s2;     ///< estimated smoothing bias of a
  std::vector<double> mass_part_m_s2;  ///< change of a by one standard deviation of the mass
  /// Change of v and a of every point by one standard deviation of each of the calibration's modes; empty where a mode
  /// does not touch the track.
  std::vector<std::vector<MotionShift>> calibration;
};

enum class Misfit { widens, ignored };

inline constexpr std::size_t kFewestLinePoints = 5;
/// Nothing where there are fewer than kFewestLinePoints points or all v are equal.
std::optional<LineFit> fit_line(int direction, const LineInput& input, const std::vector<double>& autocovariance,
                                double scale_sd_relative, Misfit misfit = Misfit::widens);

/// Residuals of a + k v at the input's points compared with what the noise of the positions gives.
struct Scatter {
  double ratio = 0.0;  ///< mean square over that expected; 0 where no noise is
  double limit = 0.0;  ///< chi2_ratio_limit() of as many residuals as are independent
  bool significant() const { return ratio > 0.0 && ratio >= limit; }
};
Scatter scatter_of(const LineInput& input, const std::vector<double>& residual, double k_1_s,
                   const std::vector<double>& autocovariance);

/// Fills in the standard deviations and intervals of K/m and a0 from line.parts.
void complete_line(LineFit& line);

/// Relative standard deviation of a camera's or a sensor's clock, where nothing else is known: that of a quartz
/// crystal over the temperatures of a room (docs/reference/cameras.md, G1). A clock that is slow by e makes K/m (1 + e)
/// and a0 (1 + e)^2 times as large, on all lines alike.
inline constexpr double kClockSdRelative = 2e-5;

/// Changes of the line by one standard deviation of everything that it may share with others: the kernel's bias (what
/// the line keeps of it), the mass, the scale, the clock, the calibration's modes; in the same order for all lines
/// (those that are missing at the end are 0).
std::vector<LineShift> shared_shifts(const LineFit& line);

/// Where the line of v > 0 meets a = 0. Null with the reason where there is no such line, where a0 is not above zero
/// by 1.96 standard deviations (a level track: no equilibrium at v > 0), or where K/m is not.
Quantity limit_velocity(const std::vector<LineFit>& lines);

/// Delete-one jackknife of a line: how far leaving out each of n parts of its points moves it.
///
///     cov = (n - 1)/n sum d_i d_i^T      d_i: change of (K/m, a0) without part i
///
/// Puts the jackknife's covariance into `parts` where one of its variances is larger than chance allows
/// (chi2_ratio_limit); variances only grow, and n - 2 degrees of freedom are left. Returns whether it did. Asserts n >=
/// 3.
bool widen_by_jackknife(const std::vector<Eigen::Vector2d>& moved, LineUncertainty& parts);

/// Every stretch is smoothed with its own points alone. Within this many bandwidths of its first or last point the
/// kernel is not complete there; what that costs, and why these points are left out: with c the distance in bandwidths,
/// the variance of a is 1.64 (c = 2.5), 1.17 (c = 3), 1.04 (c = 3.5) of what it is inside, and grows 500 times towards
/// c = 0; its bias is 0.78, 0.90 and 0.97 of the inner h^2 x''''/2.
inline constexpr double kKernelMargin = 2.5;

/// Inside a stretch a kernel with a gap is left out where the variance of a exceeds that of a complete kernel by this.
inline constexpr double kGapVariance = 2.0;

/// A smoothed point of a free stretch, and whether it counts for a line.
struct StretchPoint {
  std::size_t point = 0;  ///< of the motion
  std::size_t stretch = 0;
  int direction = 0;
  LeftOut left_out = LeftOut::used;
  bool smoothed = false;
  SmoothedPoint x;               ///< x, v, a
  SmoothedPoint y;               ///< y, y', y'': without the known force
  std::optional<KernelRow> row;  ///< over the points of the motion; without one it is in no line
};

/// Which points a caller needs: where only those that may count are wanted, those at a stretch's ends are not smoothed
/// at all (each has a kernel of its own, which is most of the work).
enum class WantedPoints { all, inner };

/// Every `stride`-th point of every stretch; with `inner` without those in the margins and without whole stretches that
/// are left out.
std::vector<StretchPoint> smooth_stretches(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                           double bandwidth_s, std::size_t stride = 1,
                                           WantedPoints wanted = WantedPoints::all);

/// The error of a that the law's own curvature over time would give: g(t) = f(v(t)) is what a without the force should
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
