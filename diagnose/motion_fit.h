/// Least squares of the nominal model with any set of effects to all motions at once.
///
///     x_ij = x(t_ij; K, mu, alpha_group, masses, effects; x0_i, v0_i, own_i) + sum_k c_k shared_k(t_ij) + noise
///
/// weighted with the noise of each motion; what is stated joins as data of its own: inclinations with their standard
/// deviation, masses with theirs, the camera's and plane's errors c_k ~ N(0, 1). Gauss and Newton's steps damped by
/// Levenberg and Marquardt, derivatives by finite differences, each motion's own parameters eliminated. An effect's
/// common parameter stays within its range (effect_ranges.h): it stops at the edge, the others go on.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

#include "diagnose/effect_list.h"
#include "diagnose/effect_ranges.h"
#include "diagnose/track_model.h"
#include "diagnose/track_set.h"

namespace glidelab::diagnose {

/// What is later than stated of each point of each motion (dropped frames); empty: nothing.
using Lateness = std::vector<std::vector<double>>;

/// Which parameters there are, and where they stand.
class ParameterLayout {
 public:
  ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects);

  struct Global {
    enum class Kind { k, mu, alpha, mass, mode, scale, effect } kind;
    std::size_t index = 0;  ///< of the group, mass or mode
    const EffectParameter* parameter = nullptr;
    std::size_t effect = 0;
    double step = 0.0;
    ParameterRange range = {};  ///< of an effect: what it may be
  };
  const std::vector<Global>& globals() const { return globals_; }
  const std::vector<const EffectParameter*>& own() const { return own_; }  ///< after x0, v0
  const std::vector<std::size_t>& effects() const { return effects_; }
  /// Index among globals of an effect's first parameter that is not own.
  std::size_t first_of(std::size_t effect) const;
  /// Ranges that hold where a fit starts: what was found in whole clips may lie beyond what a part of them shows.
  void widen_to(const Eigen::VectorXd& start);

 private:
  std::vector<Global> globals_;
  std::vector<const EffectParameter*> own_;
  std::vector<std::size_t> effects_;
};

struct FitPoint {
  Eigen::VectorXd global;
  std::vector<Eigen::VectorXd> own;  ///< x0, v0 (at the motion's first point), then the effects' own
};

/// Residuals over the noise, and their derivatives (of the model) by the parameters, over the noise.
struct FitMotion {
  Eigen::VectorXd residual;  ///< of unit white noise
  Eigen::VectorXd plain;     ///< over each position's own noise, with what neighbours share of it
  Eigen::MatrixXd global;
  Eigen::MatrixXd own;
  std::vector<double> v_m_s;
};

/// A statement as one more residual: (stated - parameter)/sd.
struct FitStatement {
  std::size_t global = 0;
  double value = 0.0;
  double sd = 0.0;
  std::string against;
  bool counts = true;  ///< false: holds back what the data leave open, and is no evidence
};

struct MotionFit {
  std::vector<std::size_t> effects;
  std::shared_ptr<const ParameterLayout> layout;
  FitPoint at;
  std::vector<FitMotion> motions;
  std::vector<FitStatement> statements;
  Lateness late;
  double cost = 0.0;  ///< chi² of positions and statements
  bool converged = false;
  int iterations = 0;
};

/// The motion of one track under the point's parameters; `unnamed` is an additional force.
TrackModel model_of(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const UnnamedForce* unnamed = nullptr);

/// What the shared errors (of camera, plane, scale, pixels) at this point add to a motion's modelled positions `x_m`.
std::vector<double> shared_errors(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at,
                                  std::size_t motion, const std::vector<double>& x_m);

/// From a point in the layout of these effects.
MotionFit fit_motions(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                      const Lateness& late = {});

/// Residuals and derivatives at a point, nothing fitted.
MotionFit linearise_at(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& at);

/// The nominal model from a first guess of its own.
MotionFit fit_nominal(const TrackSet& set, const Lateness& late = {});

/// The point of a fit in the layout of more effects, which are absent but for `values` (in the order of the new
/// effects' global parameters).
FitPoint with_effect(const TrackSet& set, const MotionFit& fit, std::size_t effect, const std::vector<double>& values,
                     const std::vector<std::vector<double>>& own);

}  // namespace glidelab::diagnose
