/// Exact tests of a proportion.
#pragma once

#include <cstddef>

namespace glidelab::validate {

/// P(X <= k) for n trials with probability p; k < 0 gives 0. Computed by summing the terms.
double binomial_cdf(long k, std::size_t n, double p);

/// Two-sided: twice the smaller tail, at most 1.
double binomial_p_value(std::size_t k, std::size_t n, double p);

/// Interval of a proportion with at least the given confidence (Clopper and Pearson 1934), to 1e-9.
struct ProportionInterval {
  double low = 0.0;
  double high = 1.0;
};
ProportionInterval proportion_interval(std::size_t k, std::size_t n, double confidence);

}  // namespace glidelab::validate
