#include "validate/study/requirement/candidate.h"

#include <algorithm>

namespace glidelab::validate {

std::vector<std::uint64_t> looks(std::uint64_t most) {
  std::vector<std::uint64_t> sizes = {std::min(kLeastRendered, most)};
  while (sizes.back() < most) sizes.push_back(std::min(2 * sizes.back(), most));
  return sizes;
}

double confidence_of_look(std::uint64_t most) {
  return 1.0 - (1.0 - kConfidence) / static_cast<double>(looks(most).size());
}

}  // namespace glidelab::validate
