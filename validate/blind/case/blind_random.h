/// The random draws of blind cases.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace glidelab::validate {

inline constexpr double kTurn = 2.0 * std::numbers::pi;  ///< a whole one

using BlindRandom = std::mt19937_64;

/// Uniform in [low, high), evenly over the logarithm, and a standard normal deviate.
double uniform(BlindRandom& random, double low, double high);
double log_uniform(BlindRandom& random, double low, double high);
double normal(BlindRandom& random);

/// One of these words, each as likely as another; there is at least one.
inline const std::string& one_of(const std::vector<std::string>& words, BlindRandom& random) {
  const auto drawn = static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(words.size())));
  return words[std::min(words.size() - 1, drawn)];
}

/// The same of values.
template <typename T, std::size_t N>
T one_of(BlindRandom& random, const T (&values)[N]) {
  return values[std::min(N - 1, static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(N))))];
}

}  // namespace glidelab::validate
