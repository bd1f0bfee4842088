#include "diagnose/result/explanation.h"

#include <algorithm>

namespace glidelab::diagnose {

std::optional<Verdict> verdict_of_id(std::string_view id) {
  for (const Verdict verdict : {Verdict::none, Verdict::effect, Verdict::unknown}) {
    if (verdict_id(verdict) == id) return verdict;
  }
  return {};
}

bool Explanation::holds(const std::string& id) const {
  return std::find(effects.begin(), effects.end(), id) != effects.end();
}

Verdict verdict_by(double none, double unknown) {
  constexpr double kMostNothingForClaim = 0.25;  // probability of nothing above which nothing else is claimed
  const double named = std::max(0.0, 1.0 - none - unknown);
  if (none >= kMostNothingForClaim) return Verdict::none;
  return named >= unknown ? Verdict::effect : Verdict::unknown;
}

}  // namespace glidelab::diagnose
