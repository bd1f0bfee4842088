#include "core/motion/bandwidth/bandwidth_rule.h"

#include <algorithm>

// Each rule, by the constant that its rule_*.cpp defines.
#define GLIDELAB_BANDWIDTH_RULES(RULE) \
  RULE(kLeaveOneOut)                   \
  RULE(kGeneralisedCrossValidation)    \
  RULE(kCorrelatedCrossValidation)     \
  RULE(kResidualSquares)               \
  RULE(kPlugIn)                        \
  RULE(kEmpiricalBias)                 \
  RULE(kIntersectionOfIntervals)

namespace glidelab::core {

#define GLIDELAB_DECLARE_RULE(rule) extern const BandwidthRule rule;
GLIDELAB_BANDWIDTH_RULES(GLIDELAB_DECLARE_RULE)
#undef GLIDELAB_DECLARE_RULE

const std::vector<BandwidthRule>& bandwidth_rules() {
#define GLIDELAB_LIST_RULE(rule) rule,
  static const std::vector<BandwidthRule> rules = {GLIDELAB_BANDWIDTH_RULES(GLIDELAB_LIST_RULE)};
#undef GLIDELAB_LIST_RULE
  return rules;
}

const BandwidthRule* find_bandwidth_rule(std::string_view name) {
  const std::vector<BandwidthRule>& rules = bandwidth_rules();
  const auto found = std::ranges::find(rules, name, &BandwidthRule::name);
  return found == rules.end() ? nullptr : &*found;
}

std::vector<std::string> bandwidth_choices() {
  std::vector<std::string> names = {std::string(kLinesRule)};
  for (const BandwidthRule& rule : bandwidth_rules()) names.emplace_back(rule.name);
  return names;
}

}  // namespace glidelab::core
