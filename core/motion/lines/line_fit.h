/// The line a = a0 - (K/m) v by ordinary least squares through smoothed points, as the paper fits it, with the effect
/// of the position noise on its coefficients.
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
/// with X the mean square residual over that expected of the noise, where X is above 1 by more than chance makes it
/// (chi2_ratio_limit of estimate.h).
/// An error of the camera or the plane displaces all positions by x_k(t), and so v by dv and a by da (the same sums
/// over the kernel); to first order the line changes by
///
///     d(K/m, a0) = (A'A)^-1 [A' (da + (K/m) dv) + (dA)' e],     (dA)' e = (- sum of dv_j e_j, 0).
///
/// Where there are four stretches or more, leaving them out one at a time (the jackknife) gives a covariance that knows
/// of no noise model; it counts where it is the larger one by more than chance makes it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "core/motion/smoothing/local_cubic.h"
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
  std::vector<double> noise_factor = {};  ///< of each measured position's noise (speed_dependent_noise.h); empty: 1
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
/// Nothing where there are fewer than kFewestLinePoints points or all v are one.
std::optional<LineFit> fit_line(int direction, const LineInput& input, const std::vector<double>& autocovariance,
                                double scale_sd_relative, Misfit misfit = Misfit::widens);

/// Residuals of a + k v at the input's points beside what the noise of the positions makes of them.
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
/// Takes the jackknife's covariance into `parts` where a variance of it is larger than chance makes it
/// (chi2_ratio_limit); variances only grow, and n - 2 degrees of freedom are left. Whether it did. Asserts n >= 3.
bool widen_by_jackknife(const std::vector<Eigen::Vector2d>& moved, LineUncertainty& parts);

}  // namespace glidelab::core
