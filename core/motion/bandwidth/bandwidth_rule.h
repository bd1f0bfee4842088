/// Rules that choose the bandwidth of the local cubic from data, and the table that names each once.
///
/// Every rule stands in a rule_*.cpp of its own, which begins with what it minimises and its source. `cv`, `gcv`,
/// `cv-correlated` and `rsc` judge x; their h is converted to that for a by the constants of kernel_constants.h, which
/// holds where x'''' varies little over the kernel. All rules here judge single points and know of no line; the
/// default of `analyze` (rule_lines.h) serves the lines. The paper took its rule from its reference [15], which is not
/// in its text; none of these is claimed to be it.
///
/// To add a rule: rule_<name>.cpp, which defines its BandwidthRule, and one line in bandwidth_rule.cpp.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/smoothing/noise.h"

namespace glidelab::core {

/// A part of the motion that is smoothed with its own points alone.
struct MotionPart {
  std::span<const double> t_s;
  std::span<const double> x_m;
};

struct BandwidthProblem {
  std::vector<MotionPart> parts;
  PositionNoise noise;
  double step_s = 0.0;  ///< median time step
};

struct LocalBandwidth {
  double t_s = 0.0;
  double bandwidth_s = 0.0;
};

struct BandwidthPick {
  double bandwidth_s = 0.0;           ///< one for all points; of a local rule the median
  std::string method;                 ///< one line for a reader
  std::vector<LocalBandwidth> local;  ///< of a local rule only
};

struct BandwidthRule {
  std::string_view name;     ///< in options and files
  std::string_view words;    ///< what it does: "leave-one-out cross-validation of x"
  std::string_view assumes;  ///< "white noise"
  /// Nothing where the motion is too short for any bandwidth.
  std::optional<BandwidthPick> (*choose)(const BandwidthProblem& problem) = nullptr;
};

/// In the order in which people are told of them.
const std::vector<BandwidthRule>& bandwidth_rules();

/// Null where there is no rule of the name.
const BandwidthRule* find_bandwidth_rule(std::string_view name);

/// The name of the default, which serves the lines and is no rule of this table (rule_lines.h).
inline constexpr std::string_view kLinesRule = "lines";

/// What a person may ask for: kLinesRule, then the table's names.
std::vector<std::string> bandwidth_choices();

}  // namespace glidelab::core
