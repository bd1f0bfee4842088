/// The unmodelled remainder: what no cause of the list explains, as a random acceleration along the track.
///
/// In place of m dv/dt = F(x, v, t) each motion follows
///
///     dv/dt = F/m + a(t),      a(t) = w(t) + f_1 + f_2 sign(v) + f_3 (K/m) v
///
/// with w white noise of spectral density q (m²/s³), and f_1, f_2 ~ N(0, s_f²), f_3 ~ N(0, s_k²) drawn anew for every
/// motion: inclination, friction and drag that scatter from motion to motion. A fall has no friction, and its
/// inclination does not matter, so that s_f is 0 where only falls were recorded. This is the grey-box model of
/// Kristensen, Madsen and Jørgensen (Automatica 40, 225, 2004), a stochastic differential equation whose noise stands
/// for what the model lacks. Here a(t) is constant over each of up to 24 parts of a motion, so that its effect on x is
/// a sum of known columns,
///
///     x = x_model + B a + noise,     B_j(t) = response of dv/dt = -(K/m) v + [t in part j],     a ~ N(0, S(q, s_f,
///     s_k))
///
/// and the likelihood, with all parameters of the fit and the start of each motion integrated out over flat priors
/// (REML), costs a few products of small matrices, independent of the number of frames. The model is linear in the
/// neighbourhood of a fit. A motion that is worse than the others (a kick, a hand) may have a remainder that is larger
/// by a factor of its own. SI units.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

struct RemainderSizes {
  double q_m2_s3 = 0.0;       ///< spectral density of the white part
  double force_m_s2 = 0.0;    ///< s_f
  double drag = 0.0;          ///< s_k, relative to K
  std::vector<double> wider;  ///< of each motion, a factor on the square root of q, on s_f and on s_k; empty: 1
  double of(std::size_t motion) const { return wider.empty() ? 1.0 : wider[motion]; }
};

/// Further columns of common parameters, each with the prior N(0, sd²): a function without a name. The rows are those
/// of all motions, one motion after the other, in units of the noise, as in ScoreSpace.
struct RemainderExtra {
  Eigen::MatrixXd columns;
  double sd = 0.0;
};

/// The likelihood of a fit with a remainder. `fit` must be linearised (by central differences) with the position noise
/// alone.
class RemainderSpace {
 public:
  RemainderSpace(const TrackSet& set, const MotionFit& fit, const RemainderExtra* extra = nullptr);

  /// Log likelihood of the positions. Parameters are integrated out over flat priors, stated quantities and the sizes
  /// of the extra columns over theirs. A K, a gravity or an inclination with a range is integrated over that range
  /// alone, whether the fit is at its edge or not. It holds up to a constant that all fits to one set share, and
  /// without the 0.5 log(2 pi) of each parameter. The factor f of a motion costs 4 log f.
  /// A motion's own parameters count in units of what they do to its positions, so that it does not matter which speed
  /// describes it, that of its start or that of its end.
  double log_likelihood(const RemainderSizes& sizes) const;

  /// chi² of the positions and statements at the minimum under these sizes.
  double chi2(const RemainderSizes& sizes) const;

  struct Best {
    RemainderSizes sizes;
    double log_likelihood = 0.0;
  };
  /// The likeliest sizes, by a search along the logarithm of each, from `start` if it is given.
  Best likeliest(const RemainderSizes* start = nullptr) const;

  /// The change of the common parameters from the fit to the minimum under these sizes, their covariance by the model,
  /// and their covariance by the scatter of the clips' scores (recovered.h).
  struct Solution {
    Eigen::VectorXd change;
    Eigen::MatrixXd covariance, between_clips;
  };
  Solution solve(const RemainderSizes& sizes) const;

  /// The mean length of a part in s. The average of w over a part has the variance q/length.
  double part_s() const { return part_s_; }

 private:
  struct Motion {
    Eigen::MatrixXd z_z;  ///< products of [residual, common, extra, own]
    Eigen::MatrixXd z_b;  ///< products of [residual, common, extra, own] with the columns of the parts
    Eigen::MatrixXd b_b;
    double part_s = 0.0;
    Eigen::MatrixXd shapes;  ///< parts x 3: 1, sign(v), (K/m) v
    Eigen::Index own = 0;
    std::size_t clip = 0;
  };
  struct Sums {
    double log_determinant = 0.0;
    double square = 0.0;
    Eigen::VectorXd right;
    Eigen::MatrixXd normal;
    void add(const Sums& of, double sign) {
      log_determinant += sign * of.log_determinant;
      square += sign * of.square;
      right += sign * of.right;
      normal += sign * of.normal;
    }
  };
  /// A stated parameter with a range.
  struct Ranged {
    Eigen::Index global = 0;
    double at = 0.0, low = 0.0, high = 0.0;
    bool held = false;                             ///< at an edge,
    double held_weight = 0.0;                      ///< by this weight in place of
    double prior_weight = 0.0, prior_right = 0.0;  ///< those of its prior, and of its score
  };
  double log_within_ranges(const Eigen::MatrixXd& lower, const Eigen::VectorXd& along) const;
  Sums stated() const;
  Sums sums_of(std::size_t motion, const RemainderSizes& sizes, double wider) const;
  Sums sums_of(const RemainderSizes& sizes) const;
  double log_likelihood(const Sums& sums) const;
  void widen_the_worst(Best& best) const;

  std::vector<Motion> motions_;
  Eigen::VectorXd stated_weight_, stated_right_;
  double stated_square_ = 0.0;
  std::vector<Ranged> ranged_;
  Eigen::Index common_ = 0, extra_ = 0;
  double extra_sd_ = 0.0, part_s_ = 0.0;
  bool only_falls_ = false;
  Eigen::VectorXd scale_;
};

/// Adds the remainder to the noise of each motion of `set`, so that every fit, scan and evidence counts it as noise.
void add_remainder(const MotionFit& fit, const RemainderSizes& sizes, TrackSet& set);

/// A fit that counts a remainder as noise, the motions with that noise, and the remainder.
struct BesideRemainder {
  TrackSet set;
  MotionFit fit;
  RemainderSizes remainder = {};
};

/// A fit linearised with its own remainder, of these sizes, as noise.
BesideRemainder beside_remainder(const TrackSet& set, const MotionFit& fit, const RemainderSizes& sizes);

/// The effects of a fit beside the remainder that is likeliest for it, fitted again.
BesideRemainder beside_own_remainder(const TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
