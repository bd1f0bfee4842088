/// One motion at a point of the parameters: what the model leaves of its positions, and the model's derivatives.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "diagnose/fit/parameter_layout.h"

namespace glidelab::diagnose {

/// What is later than stated of each point of each motion (dropped frames); empty: nothing.
using Lateness = std::vector<std::vector<double>>;

/// Residuals over the noise, and their derivatives (of the model) by the parameters, over the noise.
struct FitMotion {
  Eigen::VectorXd residual;  ///< of unit white noise
  Eigen::VectorXd plain;     ///< over each position's own noise, with what neighbours share of it
  Eigen::MatrixXd global;
  Eigen::MatrixXd own;
  std::vector<double> v_m_s;
};

/// `forward` finds the way of a fit in half the time; `central`, with an error that is the square of that, is for what
/// rests on the result: what is left of an effect that the nuisance nearly takes up must not be their error.
enum class Derivatives { none, forward, central };

/// Of the motion with this index, by finite differences.
FitMotion linearise(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const Lateness& late, Derivatives derivatives);

}  // namespace glidelab::diagnose
