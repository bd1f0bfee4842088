/// Numbers with their uncertainty.
#pragma once

#include <optional>
#include <string>

#include "core/result/results.h"

namespace glidelab::core {

/// The value with its 95 % interval: Student's t of `degrees` degrees of freedom, the normal distribution where they
/// are infinite.
Estimate estimate(double value, double sd, double degrees);

/// The 97.5 % quantile of Student's t for any degrees >= 1 (Cornish-Fisher series in 1/degrees, exact to 1 % for
/// degrees >= 3 and to 1e-4 for degrees >= 10; closed forms below 3).
double student_t975(double degrees);

/// chi^2 per degree of freedom that is exceeded by chance with a probability of 0.00135, as three standard deviations
/// are by a normal number (Wilson and Hilferty 1931; the probability is right to a tenth from 2 degrees on).
double chi2_ratio_limit(double degrees);

/// `noise_sd`: the random part of the estimate's standard deviation (Quantity).
Quantity determined(const Estimate& estimate, std::optional<double> noise_sd = {});
Quantity undetermined(std::string why);

}  // namespace glidelab::core
