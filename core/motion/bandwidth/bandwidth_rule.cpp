#include "core/motion/bandwidth/bandwidth_rule.h"

#include "core/motion/bandwidth/bandwidth_cross_validation.h"
#include "core/motion/bandwidth/bandwidth_derivative_rules.h"

namespace glidelab::core {

const std::vector<std::string>& bandwidth_rule_names() {
  static const std::vector<std::string> names{"cv", "gcv", "cv-correlated", "rsc", "plug-in", "ebbs", "ici"};
  return names;
}

std::unique_ptr<BandwidthRule> make_bandwidth_rule(std::string_view name) {
  if (name == "cv") return std::make_unique<LeaveOneOut>();
  if (name == "gcv") return std::make_unique<GeneralisedCrossValidation>();
  if (name == "cv-correlated") return std::make_unique<CorrelatedCrossValidation>();
  if (name == "rsc") return std::make_unique<ResidualSquares>();
  if (name == "plug-in") return std::make_unique<PlugIn>();
  if (name == "ebbs") return std::make_unique<EmpiricalBias>();
  if (name == "ici") return std::make_unique<IntersectionOfIntervals>();
  return nullptr;
}

}  // namespace glidelab::core
