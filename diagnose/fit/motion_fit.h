/// Least squares of the nominal model with any set of effects to all motions at once.
///
///     x_ij = x(t_ij; K, mu, alpha_group, masses, effects; x0_i, v0_i, own_i) + sum_k c_k shared_k(t_ij) + noise
///
/// weighted with the noise of each motion; statements are further data: inclinations with their standard deviation,
/// masses with theirs, the camera's and plane's errors c_k ~ N(0, 1). Gauss and Newton's steps damped by Levenberg and
/// Marquardt, derivatives by finite differences, each motion's own parameters eliminated. An effect's common parameter
/// stays within its range (fit_model.h): it stops at the edge, while the others go on.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <string>
#include <vector>

#include "diagnose/fit/fit_model.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// A statement as one more residual: (stated - parameter)/sd.
struct FitStatement {
  std::size_t global = 0;
  double value = 0.0;
  double sd = 0.0;
  std::string against;
  bool counts = true;  ///< false: a prior for what the data leave open, not evidence
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

/// From a point in the layout of these effects.
MotionFit fit_motions(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                      const Lateness& late = {});

/// Residuals and derivatives at a point, nothing fitted.
MotionFit linearise_at(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& at);

/// A fit as it stands, with residuals and derivatives by the noise of another set of the same motions.
MotionFit linearise_again(const TrackSet& set, const MotionFit& fit);

/// The nominal model, from where the integrated positions put it (integrated_start.h); where that fits badly, also
/// from the stated inclinations with three rates of drag. The best of them.
MotionFit fit_nominal(const TrackSet& set, const Lateness& late = {});

/// One more effect than `base` has, from where a search puts it. Where that leads to a worse fit than `base`, which is
/// the same model with the effect absent, the fit starts again from there, by small steps; the better of the two. So
/// its cost is never above that of `base`.
MotionFit fit_with_effect(const TrackSet& set, const MotionFit& base, std::size_t effect, const FitPoint& start);

/// `fit`, or, where `base` fits better, one that starts there with the effect that `fit` has more, absent.
MotionFit no_worse_than(const TrackSet& set, const MotionFit& base, std::size_t effect, MotionFit fit);

/// The point of a fit in the layout of more effects, which are absent but for `values` (in the order of the new
/// effects' global parameters).
FitPoint with_effect(const TrackSet& set, const MotionFit& fit, std::size_t effect, const std::vector<double>& values,
                     const std::vector<std::vector<double>>& own);

}  // namespace glidelab::diagnose
