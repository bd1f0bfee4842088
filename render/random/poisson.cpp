#include "render/random/poisson.h"

#include <cmath>

#include "render/random/philox.h"

namespace glidelab::render {
PoissonTable::PoissonTable(int largest_mean) {
  for (int mean = 0; mean < largest_mean; ++mean) {
    Distribution distribution;
    double sum = 0.0;
    for (int k = 0;; ++k) {
      sum += mean == 0 ? (k == 0 ? 1.0 : 0.0) : std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0));
      distribution.below.push_back(sum);
      // The rest is below a quarter of a word's resolution; the last entry takes it.
      if (k > mean && sum > 1.0 - 0.5 * uniform_of(0)) break;
      if (k > mean + 20.0 * std::sqrt(mean + 1.0) + 20.0) break;
    }
    distribution.below.back() = 1.0;
    std::uint16_t k = 0;
    for (int i = 0; i < 256; ++i) {
      while (distribution.below[k] < i / 256.0) ++k;
      distribution.guide.push_back(k);
    }
    whole_.push_back(std::move(distribution));
  }
}

int PoissonTable::draw(double mean, std::uint32_t whole_word, std::uint32_t rest_word) const {
  const int whole = static_cast<int>(mean);
  const Distribution& distribution = whole_.at(static_cast<std::size_t>(whole));
  const double u = uniform_of(whole_word);
  int count = distribution.guide[whole_word >> 24];
  while (distribution.below[static_cast<std::size_t>(count)] < u) ++count;
  const double rest = mean - whole;
  double term = std::exp(-rest);
  double v = uniform_of(rest_word) - term;
  for (int k = 1; v > 0.0 && k < 40; ++k) {  // beyond 40 the probability is below 1e-47
    term *= rest / k;
    v -= term;
    ++count;
  }
  return count;
}

}  // namespace glidelab::render
