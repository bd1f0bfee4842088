#include "validate/study/requirement/candidate.h"

#include <fmt/format.h>

namespace glidelab::validate {

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
