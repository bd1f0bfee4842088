#include "validate/study/requirement/candidate.h"

#include <fmt/format.h>

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

std::string describe(const Candidate& candidate) {
  const char* by = candidate.judged_by == Confirm::clips ? "clips" : "tracks";
  switch (candidate.verdict) {
    case Verdict::reached:
      return fmt::format("reached, by {}", by);
    case Verdict::by_bound:
      return "reached: the bound is well below the target";
    case Verdict::unconfirmed:
      return "possible, not run";
    case Verdict::undecided:
      return fmt::format("undecided, by {}", by);
    case Verdict::missed:
      return fmt::format("missed, by {}", by);
    case Verdict::impossible:
      return "impossible";
    case Verdict::refused:
      break;
  }
  return "refused";
}

}  // namespace glidelab::validate
