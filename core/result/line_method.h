/// The two ways in which core fits the lines of a phase diagram, and the estimators' names for them.
#pragma once

namespace glidelab::core {

/// ordinary: least squares as the paper does it (line_fit.h); generalised: with the points' covariance (gls_line.h).
enum class LineMethod { ordinary, generalised };

/// The estimator's name in options and files; fit/estimators.h lists all estimators.
constexpr const char* name_of(LineMethod method) {
  return method == LineMethod::ordinary ? "phase-diagram" : "phase-diagram-gls";
}

}  // namespace glidelab::core
