/// The fit of the whole motion to the measured positions themselves: the nominal model (viscous drag, Coulomb friction,
/// gravity; equation (8) of the paper) with its reversals and without smoothing.
///
/// All clips of one configuration are fitted at once, by least squares weighted with each clip's noise:
///
///     x_i = x(t_i; k, d, f, x0_b, v0_b) + noise,
///     dv/dt = d + F(t)/m - k v - sign(v) f,     d = g sin(alpha),  f = mu g cos(alpha)
///
/// with a start (x0, v0) for every block b of free motion, and F the force recorded with the positions, if any (linear
/// between its samples). The method is Levenberg-Marquardt from several initial guesses, with sensitivities that carry
/// the jump at v = 0 (sim/sensitivity/sensitivity.h); the starts x0, v0 are eliminated block by block. For white
/// Gaussian noise this is the maximum of the likelihood, and its covariance is the Cramer-Rao bound.
///
/// Uncertainty: correlated noise enters by the sandwich H^-1 J'W Gamma W J H^-1. If the residuals are larger than the
/// noise explains (core::chi2_ratio_limit), the covariance of the scores of eight or more pieces of the motion is
/// added, with its degrees of freedom. With four blocks or more, the pieces' scores come from the residuals of each
/// block's own fit; how the blocks differ, the jackknife says. The errors of the camera and the plane, of
/// the scale, and of the mass by which a recorded force is divided are propagated as signed shifts.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

#include "core/result/results.h"

namespace glidelab::fit {

/// A block with the noise of its clip.
struct FitBlock {
  const core::FreeBlock* block = nullptr;
  std::vector<double> autocovariance_m2;
  double scale_sd_relative = 0.0;
};

/// k, d, f; or, if there is one direction only, k and the intercept d - direction f with f = 0.
struct TrajectoryFit {
  Eigen::VectorXd parameters;           ///< 3, or 2
  int direction = 0;                    ///< the only one, or 0 for both
  Eigen::MatrixXd covariance;           ///< random part
  std::vector<Eigen::VectorXd> shared;  ///< signed changes by one standard deviation of each shared error
  double degrees = 0.0;                 ///< of freedom of the covariance; infinite if the covariance is known
  double scatter = 0.0;                 ///< rms residual over the noise,
  bool scatters = false;                ///< and whether that is more than chance explains
  bool by_jackknife = false;            ///< the covariance shows how much blocks differ, not the scatter within them
  std::size_t points = 0;
  std::size_t left_out = 0;             ///< positions left out as outliers
  std::vector<Eigen::Vector2d> starts;  ///< x0, v0 of each block
  int iterations = 0;
};

inline constexpr double kLeastVariance = 1e-24;  // m²: positions without noise

/// One block's residuals (measured - model) and their derivatives with respect to the common parameters and to (x0,
/// v0).
struct Linearised {
  Eigen::VectorXd residual;
  Eigen::MatrixXd common;  ///< n x 3
  Eigen::MatrixXd start;   ///< n x 2
  Eigen::VectorXd force;   ///< derivative of the model's positions by a factor on the recorded force; empty: none

  void scale_rows(const Eigen::VectorXd& by) {
    residual.array() *= by.array();
    common.array().colwise() *= by.array();
    start.array().colwise() *= by.array();
    if (force.size() > 0) force.array() *= by.array();
  }
};

/// Variance of the noise of one position of the block.
double variance_of(const FitBlock& fit);

/// The uncertainty of a fit of the whole motion: the covariance from the noise, the scatter of residuals beyond it, and
/// the effect of errors of the camera and the scale.
///
/// With P the derivatives by the common parameters without the part that a block's own start can absorb, and H = sum of
/// P'P / s^2: covariance H^-1 [sum of P' Gamma P / s^4] H^-1, widened by the scores of pieces as described at the top
/// of this file. With four blocks or more, each is left out in turn (the jackknife, to first order: -(H - H_b)^-1 P_b'
/// r_b / s^2). The jackknife's covariance needs no noise model (rounded positions that move slowly err together). It is
/// used if one of its variances exceeds the other's by more than chance allows (chi2_ratio_limit, with n - 1 degrees of
/// freedom).
class TrajectoryUncertainty {
 public:
  /// Constructed at the minimum; all arguments must outlive this object.
  TrajectoryUncertainty(const std::vector<FitBlock>& blocks, const std::vector<Linearised>& at, int free);

  bool determined() const { return inverse_.size() > 0; }
  /// Sets the covariance with its degrees of freedom, the scatter, the number of points and the shared changes.
  void fill(TrajectoryFit& fit) const;

 private:
  /// Residuals of each block, and how many parameters were taken from all of them.
  struct Rest {
    std::vector<Eigen::VectorXd> of_block;
    double parameters = 0.0;
  };
  Rest with_parameters_of_their_own(Rest rest) const;
  void add_misfit(const std::vector<Eigen::VectorXd>& residuals, double count, double ratio, TrajectoryFit& fit) const;
  void compare_with_jackknife(TrajectoryFit& fit) const;
  void add_shared(TrajectoryFit& fit) const;

  const std::vector<FitBlock>& blocks_;
  const std::vector<Linearised>& at_;
  std::vector<Eigen::MatrixXd> projected_;
  Eigen::MatrixXd normal_, inverse_;
};

/// Robust: starting from least squares, Huber's weights are iterated until they settle (1 up to 1.5 deviations, 1.5
/// over the deviations beyond; the scale is 1.4826 times each block's median absolute residual). Then follows least
/// squares without the positions that are off by more than 4 of these deviations. Without outliers almost no position
/// is lost (6 in 1e5 normal ones).
struct TrajectoryOptions {
  bool robust = false;
};

/// `start` holds the first guess of k, d, f. Empty if no start converges or the data do not determine the parameters.
std::optional<TrajectoryFit> fit_trajectories(const std::vector<FitBlock>& blocks, const Eigen::Vector3d& start,
                                              const TrajectoryOptions& options = {});

}  // namespace glidelab::fit
