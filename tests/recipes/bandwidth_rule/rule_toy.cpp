// toy: the geometric mean of the plug-in rule's bandwidth and that of empirical bias, whose log errs by half the sum of
// their errors. The example of docs/extending.md; no source has it.
#include <cmath>

#include "core/motion/bandwidth/bandwidth_rule.h"

namespace glidelab::core {
namespace {

std::optional<BandwidthPick> between_two(const BandwidthProblem& problem) {
  const auto one = find_bandwidth_rule("plug-in")->choose(problem);
  const auto other = find_bandwidth_rule("ebbs")->choose(problem);
  if (!one || !other) return {};
  return BandwidthPick{std::sqrt(one->bandwidth_s * other->bandwidth_s),
                       found_by_rule("mean of {:.1f} ms (plug-in) and {:.1f} ms (ebbs)", 1e3 * one->bandwidth_s,
                                     1e3 * other->bandwidth_s)};
}

}  // namespace

extern const BandwidthRule kToy = {"toy", "the geometric mean of plug-in and ebbs", "what these two assume",
                                   between_two};

}  // namespace glidelab::core
