/// Rules that choose the bandwidth of the local cubic from data: the table that names each rule once, and the scan of
/// bandwidths that they share.
///
/// Every rule has a rule_*.cpp of its own, which begins with the criterion that it minimises and its source. `cv`,
/// `gcv`, `cv-correlated` and `rsc` judge x; their h is converted to that for a by the constants of local_polynomial.h,
/// which holds where x'''' varies little over the kernel. All rules here judge single points and know nothing about
/// lines; the default of `analyze`, choose_bandwidth() of rule_lines.h, serves the lines. The paper took its rule from
/// its reference [15] and does not state it; none of these rules is claimed to be it.
///
/// To add a rule: rule_<name>.cpp, which defines its BandwidthRule, and one line in bandwidth_rule.cpp.
#pragma once

#include <fmt/core.h>

#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/long_work.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/motion/smoothing/noise.h"
#include "core/result/strength.h"

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
  base::StopCheck stop_check = base::never_stop;
};

struct LocalBandwidth {
  double t_s = 0.0;
  double bandwidth_s = 0.0;
};

struct BandwidthPick {
  double bandwidth_s = 0.0;                ///< one for all points; for a local rule the median
  chosen_by::Rule by;                      ///< what the rule found: found_by_rule()
  std::vector<LocalBandwidth> local = {};  ///< for a local rule only
};

/// What a rule found, in its own words: the literal "rms x'''' of {:.3g} m/s^4" and its number. Numbers are double, as
/// they are stored; a pattern that does not fit them does not compile.
template <std::same_as<double>... Numbers>
chosen_by::Rule found_by_rule(fmt::format_string<const Numbers&...> pattern, const Numbers&... numbers) {
  const fmt::string_view found = pattern;
  return {{found.data(), found.size()}, {numbers...}};
}

struct BandwidthRule {
  std::string_view name;     ///< in options and files
  std::string_view words;    ///< what the rule does: "leave-one-out cross-validation of x"
  std::string_view assumes;  ///< "white noise"
  /// Empty if the motion is too short for any bandwidth.
  std::optional<BandwidthPick> (*choose)(const BandwidthProblem& problem) = nullptr;
};

/// In the order in which they are shown.
const std::vector<BandwidthRule>& bandwidth_rules();

/// Null if there is no rule of that name.
const BandwidthRule* find_bandwidth_rule(std::string_view name);

/// The name of the default, which serves the lines and is not a rule of this table (rule_lines.h).
inline constexpr std::string_view kLinesRule = "lines";

/// What a user may ask for: kLinesRule, then the table's names.
std::vector<std::string> bandwidth_choices();

/// InputError for a bandwidth that is not a time above 0, and for a rule's name that is neither empty nor in the table.
void check_bandwidth(const std::optional<double>& bandwidth_s, const std::string& rule);

inline constexpr double kLeastBandwidthSteps = 1.2;  ///< time steps; a narrower kernel holds fewer than five points
inline constexpr double kBandwidthRatio = 1.1;       ///< ratio of successive bandwidths tried

/// A point of a part, given by its index there.
struct Probe {
  std::size_t part = 0;
  std::size_t point = 0;
};

/// What the bandwidth rules share: the bandwidths tried, and the points at which the criterion is evaluated.
class BandwidthScan {
 public:
  explicit BandwidthScan(const BandwidthProblem& problem);

  /// From kLeastBandwidthSteps time steps to a fifth of the longest part.
  const std::vector<double>& grid() const { return grid_; }
  /// At most about 400 in all parts, evenly spaced. A tenth of each part at both ends is left out, because kernels
  /// there are incomplete and their variance would dominate the criterion.
  const std::vector<Probe>& probes() const { return probes_; }
  const BandwidthProblem& problem() const { return problem_; }

  /// One smoother for each part.
  std::vector<LocalPolynomial> smoothers(double bandwidth_s, Kernel kernel = Kernel::gaussian) const;

  double time(const Probe& probe) const { return problem_.parts[probe.part].t_s[probe.point]; }
  double position(const Probe& probe) const { return problem_.parts[probe.part].x_m[probe.point]; }

 private:
  const BandwidthProblem& problem_;
  std::vector<double> grid_;
  std::vector<Probe> probes_;
};

/// The index of the grid's smallest value, ignoring NaN. Empty if all are NaN.
std::optional<std::size_t> least(const std::vector<double>& criterion);

/// The widest of the grid's local minima. Cross-validation often has spurious ones at narrow bandwidths, especially
/// with correlated noise; the widest is the better one (Hall and Marron 1991, J. R. Stat. Soc. B 53, 245).
std::optional<std::size_t> widest_local_least(const std::vector<double>& criterion);

/// At which end of the grid a choice lies, if at one.
chosen_by::Rule::Edge edge_of(const std::vector<double>& grid, std::size_t choice);

}  // namespace glidelab::core
