/// Exact Poisson numbers for small means, from two uniform words each.
///
/// Poisson(mean) is the sum of Poisson(n), n the whole part of the mean, and Poisson(the rest): the first by inversion
/// of a tabulated distribution (found through a guide, so that it takes a few steps at any mean), the second by
/// sequential inversion. Exact to the 2^-32 of a uniform word.
#pragma once

#include <cstdint>
#include <vector>

namespace glidelab::render {

class PoissonTable {
 public:
  /// For means in [0, largest_mean).
  explicit PoissonTable(int largest_mean);
  int draw(double mean, std::uint32_t whole_word, std::uint32_t rest_word) const;

 private:
  struct Distribution {
    std::vector<double> below;         ///< P(N <= k)
    std::vector<std::uint16_t> guide;  ///< the k at which to start, by the word's upper 8 bits
  };
  std::vector<Distribution> whole_;
};

}  // namespace glidelab::render
