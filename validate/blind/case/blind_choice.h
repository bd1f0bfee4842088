/// A draw among words or values, each as likely as another.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

/// `words` are not empty.
inline const std::string& one_of(const std::vector<std::string>& words, BlindRandom& random) {
  const auto drawn = static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(words.size())));
  return words[std::min(words.size() - 1, drawn)];
}

template <typename T, std::size_t N>
T one_of(BlindRandom& random, const T (&values)[N]) {
  return values[std::min(N - 1, static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(N))))];
}

}  // namespace glidelab::validate
