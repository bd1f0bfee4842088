/// A fit of all motions (motion_fit.h), finished or at one of its steps: parameters, residuals with their derivatives,
/// and statements.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "diagnose/fit/fit_model.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// A statement as an additional residual: (stated - parameter)/sd.
struct FitStatement {
  std::size_t global = 0;
  double value = 0.0;
  double sd = 0.0;
  std::optional<Against> against = {};  ///< none: a prior
  bool counts = true;                   ///< false: a prior for what the data leave undetermined, not evidence
  struct Prior {
    double value = 0.0, sd = 0.0;
  };
  /// The prior of a parameter that stopped at the edge of its range; `value` and `sd` then hold it there.
  std::optional<Prior> held = {};

  /// What it states of its parameter, whether or not it holds it.
  Prior prior() const { return held.value_or(Prior{value, sd}); }
  /// What it adds to chi² at this value of its parameter.
  double chi2(double at) const { return std::pow((prior().value - at) / prior().sd, 2); }
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

}  // namespace glidelab::diagnose
