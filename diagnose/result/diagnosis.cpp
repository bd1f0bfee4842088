#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

bool only_statements_fail(const Diagnosis& diagnosis) {
  constexpr double kAtFloor = 5.0;  // standard errors above the floor: no more is a gap at the floor
  const bool explained = diagnosis.gap && diagnosis.gap->before < 1.0 + kAtFloor * diagnosis.gap->standard_error;
  return diagnosis.verdict == Verdict::unknown && explained &&
         !(diagnosis.limits.driving.empty() && diagnosis.limits.contradicted.empty());
}

}  // namespace glidelab::diagnose
