/// How much larger a parameter's uncertainty is than for independent errors, from the scatter of its scores over blocks
/// of data.
///
/// A score s_k = (design) (residual) of a datum moves the parameter; for independent errors the sum over a block has
/// the variance sum of var(s_k). If neighbouring errors are correlated (an image's sampling, a track that is not
/// straight), the sums over ten blocks scatter more:
///
///     ratio = sum over blocks of (sum of s_k)² / sum of var(s_k)  10/(10 - 2),
///
/// because two parameters are fitted. It is used if it is above 1 by two of its standard deviations, sqrt(2/10).
#pragma once

#include <cmath>
#include <cstddef>

namespace glidelab::core {

inline constexpr std::size_t kScatterBlocks = 10;

/// Sum over the blocks of the squared sum of their scores; score(k) is the score of the k-th of `count` data.
template <typename Score>
double scatter_of_blocks(std::size_t count, const Score& score) {
  double scatter = 0.0;
  for (std::size_t block = 0; block < kScatterBlocks; ++block) {
    double sum = 0.0;
    for (std::size_t k = block * count / kScatterBlocks; k < (block + 1) * count / kScatterBlocks; ++k) sum += score(k);
    scatter += sum * sum;
  }
  return scatter;
}

/// The ratio by which a variance grows; 1 if it is not significantly above 1. `independent`: sum of the scores'
/// variances.
inline double excess_over_independent(double scatter, double independent) {
  const double ratio = scatter / independent * kScatterBlocks / (kScatterBlocks - 2.0);
  return ratio > 1.0 + 2.0 * std::sqrt(2.0 / kScatterBlocks) ? ratio : 1.0;
}

}  // namespace glidelab::core
