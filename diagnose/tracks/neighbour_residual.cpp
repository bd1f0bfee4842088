#include "diagnose/tracks/neighbour_residual.h"

#include <cmath>

namespace glidelab::diagnose {

double neighbour_residual(const std::vector<double>& t, const std::vector<double>& x, std::size_t i) {
  double off = x[i], gain = 1.0;
  for (const std::size_t a : {i - 2, i - 1, i + 1, i + 2}) {
    double weight = 1.0;
    for (const std::size_t b : {i - 2, i - 1, i + 1, i + 2}) {
      if (b != a) weight *= (t[i] - t[b]) / (t[a] - t[b]);
    }
    off -= weight * x[a];
    gain += weight * weight;
  }
  return off / std::sqrt(gain);
}

}  // namespace glidelab::diagnose
