#include "validate/study/sweep/design/sweep.h"

#include <fmt/format.h>

namespace glidelab::validate {

std::string Analysis::name() const {
  if (bandwidth_s) return fmt::format("{} h={} s", estimator, *bandwidth_s);
  return bandwidth_rule.empty() ? estimator : fmt::format("{} {}", estimator, bandwidth_rule);
}

}  // namespace glidelab::validate
