#include "validate/truth/binomial.h"

#include <algorithm>
#include <cmath>

namespace glidelab::validate {
namespace {

/// The p at which `tail`, which rises with p, equals `level`.
template <class Tail>
double where(double level, const Tail& tail) {
  double low = 0.0, high = 1.0;
  while (high - low > 1e-10) {
    const double middle = 0.5 * (low + high);
    (tail(middle) < level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double binomial_cdf(long k, std::size_t n, double p) {
  if (k < 0) return 0.0;
  if (static_cast<std::size_t>(k) >= n || p <= 0.0) return 1.0;
  if (p >= 1.0) return 0.0;
  const auto trials = static_cast<double>(n);
  double sum = 0.0;
  for (long i = 0; i <= k; ++i) {
    const auto hits = static_cast<double>(i);
    sum += std::exp(std::lgamma(trials + 1.0) - std::lgamma(hits + 1.0) - std::lgamma(trials - hits + 1.0) +
                    hits * std::log(p) + (trials - hits) * std::log1p(-p));
  }
  return std::min(sum, 1.0);
}

double binomial_p_value(std::size_t k, std::size_t n, double p) {
  const auto hits = static_cast<long>(k);
  const double below = binomial_cdf(hits, n, p), above = 1.0 - binomial_cdf(hits - 1, n, p);
  return std::min(1.0, 2.0 * std::min(below, above));
}

ProportionInterval proportion_interval(std::size_t k, std::size_t n, double confidence) {
  const double tail = 0.5 * (1.0 - confidence);
  const auto hits = static_cast<long>(k);
  ProportionInterval interval;
  if (k > 0) interval.low = where(tail, [&](double p) { return 1.0 - binomial_cdf(hits - 1, n, p); });
  if (k < n) interval.high = where(1.0 - tail, [&](double p) { return 1.0 - binomial_cdf(hits, n, p); });
  return interval;
}

}  // namespace glidelab::validate
