/// The line a = a0 - (K/m) v by ordinary least squares through the smoothed points of free stretches, as the paper fits
/// it, with the effect of the position noise on its coefficients.
///
/// Smoothed points are correlated over the kernel, so the textbook formula for independent points is wrong here. But v
/// and a are linear in the measured positions, and so, to first order in the noise n, are the coefficients:
///
///     d(K/m, a0) = (A'A)^-1 A' (da + (K/m) dv) = L n,     A_j = (-v_j, 1),     covariance = L Sigma L'
///
/// with Sigma the estimated autocovariance of the noise. The neglected term, (dA)'(residual), is of second order: it
/// shrinks K/m by var(v noise) / var(v), which is below 1e-3 wherever the lines are worth fitting.
///
/// If the points lie off the line by more than the noise explains (the law is not a line, the track is not straight),
/// the covariance grows by that part of their scatter: the residuals are cut into eight or more blocks in time, never
/// across stretches, and
///
///     covariance += (1 - 1/X) (A'A)^-1 [ sum over blocks of s s' ] (A'A)^-1  n_b / (n_b - 2),   s = sum of A_j' e_j,
///
/// with X the mean square residual over that expected from the noise, if X is above 1 by more than chance allows
/// (chi2_ratio_limit of estimate.h).
///
/// An error of the camera or the plane displaces all positions by x_k(t), and therefore v by dv and a by da (the same
/// sums over the kernel). To first order the line changes by
///
///     d(K/m, a0) = (A'A)^-1 [A' (da + (K/m) dv) + (dA)' e],     (dA)' e = (- sum of dv_j e_j, 0).
///
/// With four stretches or more, leaving out one at a time (the jackknife) gives a covariance that needs no noise model;
/// it is used if it is larger by more than chance allows.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/result/estimate.h"
#include "core/result/results.h"

namespace glidelab::core {

struct MotionShift {
  double v_m_s = 0.0;
  double a_m_s2 = 0.0;
};

/// The points of one direction, and how they depend on the `track_points` measured positions.
struct LineInput {
  std::size_t track_points = 0;
  std::vector<double> t_s;                ///< of the measured positions
  bool forced = false;                    ///< a known force acts
  std::vector<double> noise_factor = {};  ///< of each measured position's noise (stretch_noise.h); empty: 1
  std::vector<double> v_m_s;
  std::vector<double> a_m_s2;          ///< with the known force's part F/m subtracted
  std::vector<KernelRow> rows;         ///< over the measured positions
  std::vector<std::size_t> stretch;    ///< the stretch of each point; stretches are consecutive
  std::vector<double> bias_a_m_s2;     ///< estimated smoothing bias of a
  std::vector<double> mass_part_m_s2;  ///< change of a for one standard deviation of the mass
  /// Change of v and a of every point for one standard deviation of each of the calibration's modes; empty if a mode
  /// does not affect the track.
  std::vector<std::vector<MotionShift>> calibration;
};

/// The covariance of two lines' coefficients from the noise of positions on which both rest.
LineCross cross_covariance(const LineInput& one, const LineFit& of_one, const LineInput& other, const LineFit& of_other,
                           const std::vector<double>& autocovariance);

/// Whether v varies over the points by more than three standard deviations of that variation, so that a slope can be
/// known: with n_j the noise of v_j about the mean of all, sum of (v_j - mean)^2 >= 9 sum of var n_j.
bool speed_varies(const LineInput& input, const std::vector<double>& autocovariance);

enum class Misfit { widens, ignored };

inline constexpr std::size_t kFewestLinePoints = 5;
/// Empty if there are fewer than kFewestLinePoints points or all v are equal.
std::optional<LineFit> fit_line(int direction, const LineInput& input, const std::vector<double>& autocovariance,
                                double scale_sd_relative, Misfit misfit = Misfit::widens);

/// Residuals of a + k v at the input's points, compared with those expected from the noise of the positions.
struct Scatter {
  double ratio = 0.0;  ///< mean square over that expected; 0 without noise
  double limit = 0.0;  ///< chi2_ratio_limit() for the number of independent residuals
  bool significant() const { return ratio > 0.0 && ratio >= limit; }
};
Scatter scatter_of(const LineInput& input, const std::vector<double>& residual, double k_1_s,
                   const std::vector<double>& autocovariance);

/// The random part of the variance of gradient.k K/m + gradient.a0 a0: the noise with the scatter of points beyond it,
/// and the part of the scatter between clips that this does not explain.
KnownVariance random_variance(const LineFit& line, const LineShift& gradient);

/// Fills in the standard deviations and intervals of K/m and a0 from line.parts.
void complete_line(LineFit& line);

/// Relative standard deviation of a camera's or a sensor's clock, if nothing else is known: that of a quartz crystal at
/// room temperatures (docs/reference/camera-sources.md, G1). A clock that is slow by e makes K/m (1 + e) times as large
/// and a0 (1 + e)^2, equally on all lines.
inline constexpr double kClockSdRelative = 2e-5;

/// Changes of the line for one standard deviation of each error that it may share with other lines: the kernel's bias
/// (the part that the line keeps), the mass, the scale, the clock, the calibration's modes. The order is the same for
/// all lines (missing ones at the end are 0).
std::vector<LineShift> shared_shifts(const LineFit& line);

/// The speed at which the line of v > 0 meets a = 0. Null with the reason if there is no such line, if a0 is not above
/// zero by 1.96 standard deviations (a level track: no equilibrium at v > 0), or if K/m is not.
Quantity limit_velocity(const std::vector<LineFit>& lines);

/// Delete-one jackknife of a line: how far leaving out each of n parts of its points moves it.
///
///     cov = (n - 1)/n sum d_i d_i^T      d_i: change of (K/m, a0) without part i
///
/// Puts the jackknife's covariance into `parts` if one of its variances is larger than chance allows
/// (chi2_ratio_limit); variances only grow, and n - 2 degrees of freedom remain. Returns whether it did. Asserts n >=
/// 3.
bool widen_by_jackknife(const std::vector<Eigen::Vector2d>& moved, LineUncertainty& parts);

/// Every stretch is smoothed with its own points alone. Within this many bandwidths of its first or last point the
/// kernel is incomplete, and the points are left out. The reason: with c the distance in bandwidths, the variance of a
/// is 1.64 (c = 2.5), 1.17 (c = 3), 1.04 (c = 3.5) times that inside, and grows 500-fold towards c = 0; its bias is
/// 0.78, 0.90 and 0.97 of the inner h^2 x''''/2.
inline constexpr double kKernelMargin = 2.5;

/// Inside a stretch, a kernel with a gap is left out if the variance of a exceeds that of a complete kernel by this
/// factor.
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
  std::optional<KernelRow> row;  ///< over the points of the motion; without a row the point is in no line
};

/// Which points a caller needs. If only those that may count are wanted, those at a stretch's ends are not smoothed at
/// all (each needs a kernel of its own, which is most of the work).
enum class WantedPoints { all, inner };

/// Every `stride`-th point of every stretch; with `inner`, without the points in the margins and without stretches that
/// are left out as a whole.
std::vector<StretchPoint> smooth_stretches(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                           double bandwidth_s, std::size_t stride = 1,
                                           WantedPoints wanted = WantedPoints::all);

/// The error of a due to the law's own curvature over time: g(t) = f(v(t)) is the expected a without the force at each
/// point (0 where unknown). The result is the smoothed minus the true g, obtained by smoothing its double integral as
/// positions are smoothed. For v' = -k v + const it is (k h)^2 / 2 of a.
std::vector<double> smoothing_bias(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<double>& law_m_s2, const std::vector<StretchPoint>& points);

/// The used points of one direction; `bias` comes from smoothing_bias() for the same points. With a known force a is
/// y'', and one standard deviation of the mass changes it by F sd / m^2.
LineInput line_input(const Motion& motion, const std::vector<StretchPoint>& points, const std::vector<double>& bias,
                     int direction, double mass_kg, double mass_sd_kg);

/// The effect of displacements of the track's positions (TrackData::shared_m) on v and a of the input's points.
std::vector<std::vector<MotionShift>> calibration_shifts(const Motion& motion, const LineInput& input,
                                                         const std::vector<std::vector<double>>& shared_m);

}  // namespace glidelab::core
