#include "core/motion/bandwidth/bandwidth_rule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/text/nearest_word.h"

// The rules, each by the constant that its rule_*.cpp defines.
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

void check_bandwidth(const std::optional<double>& bandwidth_s, const std::string& rule) {
  if (bandwidth_s && !(std::isfinite(*bandwidth_s) && *bandwidth_s > 0.0)) {
    throw base::InputError(
        base::Issue{"", 0, "bandwidth", fmt::format("{}", *bandwidth_s), "a time in seconds above 0"});
  }
  if (!rule.empty() && !find_bandwidth_rule(rule)) {
    throw base::InputError(base::Issue{"", 0, "bandwidth", fmt::format("\"{}\"", rule),
                                       fmt::format("one of {}{}", fmt::join(bandwidth_choices(), ", "),
                                                   base::did_you_mean(rule, bandwidth_choices()))});
  }
}

namespace {

constexpr double kMostPart = 0.2;             // largest bandwidth, as a fraction of the longest part
constexpr double kTrimmedAtEachEnd = 0.1;     // fraction of each part left out at each end
constexpr std::size_t kMostUsedPoints = 400;  // more are thinned

}  // namespace

BandwidthScan::BandwidthScan(const BandwidthProblem& problem) : problem_(problem) {
  double longest = 0.0;
  std::size_t points = 0;
  for (const MotionPart& part : problem.parts) {
    if (part.t_s.empty()) continue;
    longest = std::max(longest, part.t_s.back() - part.t_s.front());
    points += part.t_s.size();
  }
  for (double h = kLeastBandwidthSteps * problem.step_s; h > 0.0 && h <= kMostPart * longest; h *= kBandwidthRatio)
    grid_.push_back(h);
  const std::size_t stride = points / kMostUsedPoints + 1;
  for (std::size_t p = 0; p < problem.parts.size(); ++p) {
    const std::size_t n = problem.parts[p].t_s.size();
    const auto trim = static_cast<std::size_t>(std::ceil(kTrimmedAtEachEnd * static_cast<double>(n)));
    for (std::size_t j = trim; j + trim < n; j += stride) probes_.push_back({p, j});
  }
}

std::vector<LocalPolynomial> BandwidthScan::smoothers(double bandwidth_s, Kernel kernel) const {
  std::vector<LocalPolynomial> made;
  PolynomialOptions options;
  options.kernel = kernel;
  options.bandwidth_s = bandwidth_s;
  for (const MotionPart& part : problem_.parts) made.emplace_back(part.t_s, options);
  return made;
}

std::optional<std::size_t> least(const std::vector<double>& criterion) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < criterion.size(); ++i) {
    if (!std::isnan(criterion[i]) && (!best || criterion[i] < criterion[*best])) best = i;
  }
  return best;
}

std::optional<std::size_t> widest_local_least(const std::vector<double>& criterion) {
  std::optional<std::size_t> last;  // the last bandwidth with a value, going down
  for (std::size_t i = criterion.size(); i-- > 0;) {
    if (std::isnan(criterion[i])) continue;
    if (last && criterion[i] > criterion[*last]) return last;
    last = i;
  }
  return last;
}

chosen_by::Rule::Edge edge_of(const std::vector<double>& grid, std::size_t choice) {
  if (grid.size() == 1) return chosen_by::Rule::Edge::only;
  if (choice == 0) return chosen_by::Rule::Edge::narrowest;
  if (choice + 1 == grid.size()) return chosen_by::Rule::Edge::widest;
  return chosen_by::Rule::Edge::none;
}

}  // namespace glidelab::core
