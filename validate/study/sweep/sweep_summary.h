/// A summary of a sweep's database: for every quantity and estimator, error, stated sd and smallest possible sd over
/// each varied key, and why runs failed.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fit/outside/outside_tally.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/mass_study.h"
#include "validate/study/sweep/sweep_database.h"
#include "validate/study/sweep/sweep_groups.h"

namespace glidelab::validate {

/// Runs that failed for reasons of one kind.
struct FailureKind {
  std::string example;  ///< the first reason that was added, unchanged
  std::uint64_t runs = 0;
  bool one_text = true;  ///< all reasons are identical to the example
};

/// Why runs failed, by kind: one cause reads the same in every run except for its numbers.
///
/// A number is digits, with a decimal point and a power of ten where these follow, and a preceding minus that does not
/// follow a word. Two reasons are of one kind if their texts are the same without the numbers.
class FailureKinds {
 public:
  void add(const std::string& why);

  /// The most frequent first; kinds with equal numbers of runs are sorted by their text without numbers.
  std::vector<FailureKind> by_number() const;

 private:
  std::map<std::string, FailureKind> kinds_;
};

/// The text with "#" for each number.
std::string without_numbers(std::string_view text);

/// The text with four significant digits for each number that has more than six and is not an integer:
/// "1.5811388300841898e-05" becomes "0.00001581".
std::string with_rounded_numbers(std::string_view text);

/// Largest number of configurations for which separate plots are readable.
inline constexpr std::size_t kMostSplit = 4;

/// Summary over the values of one axis, with all others mixed.
struct AxisSummary {
  std::string name;
  std::string unit;
  bool words = false;               ///< positions are numbers of labels
  bool logarithmic = false;         ///< better plotted logarithmically
  std::vector<std::string> labels;  ///< of words
  std::vector<Series> series;
  /// In the order of SweepSummary::configurations, if there are at most kMostSplit; otherwise empty.
  std::vector<std::vector<Series>> of_configurations = {};
};

/// The error of one method's a(t): rms values over a clip's points that count, compared clip by clip with that of the
/// best possible bandwidth on the same clip.
struct AccelerationError {
  std::string configuration;  ///< empty: of all
  std::string estimator;
  std::uint64_t clips = 0;
  double median_m_s2 = 0.0;
  std::optional<double> regret, regret90;  ///< error over the best possible one: median and 90 % quantile
};

/// The bandwidths with which one method smoothed its clips: the median, and the 10 % and 90 % quantiles.
struct ChosenBandwidth {
  std::string estimator;
  double median_s = 0.0, low_s = 0.0, high_s = 0.0;
};

/// One configuration of the scenario: the same over its runs alone.
struct ConfigurationSummary {
  std::string name;
  std::vector<Series> overall;  ///< each of one group, with the likeness of the configurations
  std::vector<AccelerationError> accelerations = {};
};

/// Failed runs by the kinds of their reasons (FailureKinds).
struct FailedRuns {
  struct Kind {
    std::uint64_t runs = 0;
    bool one_text = true;      ///< all reasons are identical to `why`
    bool of_scenario = false;  ///< the scenario was refused: `why` begins with the varied values
    std::string why;           ///< an example, its numbers rounded
  };
  std::vector<Kind> kinds;  ///< the five most frequent
  std::uint64_t other_kinds = 0, other_runs = 0;
};

struct SweepSummary {
  std::string name;
  std::uint64_t runs = 0, planned = 0, failed = 0;
  FailedRuns failures;
  double cpu_s = 0.0;                                ///< wall time of all runs on their threads
  std::vector<Series> overall;                       ///< one group each
  std::vector<ConfigurationSummary> configurations;  ///< by their names; empty if the scenario has one
  std::vector<AxisSummary> axes;
  std::vector<AccelerationError> accelerations;
  std::vector<ChosenBandwidth> bandwidths = {};
  MassStudy masses;
  std::optional<fit::OutsideTally> outside = {};  ///< without times: the time of each run in `timing` covers everything
                                                  ///< else too
};

/// The summary of the runs present. InputError, EnvironmentError as for the database (sqlite.h).
SweepSummary summarize(const Sweep& sweep, Database& database);

}  // namespace glidelab::validate
