#include "validate/blind/case/blind_random.h"

#include <cmath>
#include <numbers>

namespace glidelab::validate {

// The standard leaves its distributions to each library; the engine alone is the same everywhere.
double uniform(BlindRandom& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

double log_uniform(BlindRandom& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

double normal(BlindRandom& random) {
  const double u = uniform(random, 0.0, 1.0), angle = uniform(random, 0.0, 2.0 * std::numbers::pi);
  return std::sqrt(-2.0 * std::log1p(-u)) * std::cos(angle);  // Box and Muller
}

}  // namespace glidelab::validate
