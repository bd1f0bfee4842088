/// Errors of a sweep's runs by the values of one axis, or by configuration.
///
/// If some runs have no answer, the runs at one value of an axis are not comparable with those at another: the hard
/// combinations may be missing at only one of them. In a factorial design without drawn keys the errors are then also
/// given over those combinations of the other keys (and the configuration) that are answered at every value, by half of
/// their replicates or more, all with equal weight:
///
///     rms² = mean over combinations of the mean over replicates of error²
///
/// Configurations are compared over the runs in which each has an answer, whatever the design.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sweep_database.h"

namespace glidelab::validate {

/// Statistics over the runs of one group. Standard deviations and bounds are rms values.
struct ErrorStatistics {
  std::uint64_t runs = 0;      ///< with a truth
  std::uint64_t answered = 0;  ///< of these, with a value
  double bias = 0.0;           ///< mean error
  double bias_sd = 0.0;        ///< standard error of it
  double rms = 0.0;            ///< rms error
  double sd = 0.0;             ///< as stated
  std::optional<double> least_sd;
  double coverage = 0.0;  ///< fraction of the 95 % intervals that contain the truth
  /// Errors over their stated standard deviations: mean and rms, which are 0 and 1 if the stated values are honest,
  /// each with its standard error (of the second, as for normal errors). Empty if no standard deviation was stated.
  struct InStatedSds {
    double mean = 0.0, mean_sd = 0.0;
    double rms = 0.0, rms_sd = 0.0;
  };
  std::optional<InStatedSds> in_stated_sds = {};
};

struct GroupStatistics {
  std::string label;      ///< of the value or the bin, for a table
  double position = 0.0;  ///< on a plot's axis: the value, the middle of the bin, or a number representing a word
  ErrorStatistics statistics;
  /// Over the combinations of everything else that are answered in every group; empty if all runs have an answer, and
  /// if there are none.
  std::optional<ErrorStatistics> alike = {};
};

/// Whether the contents of the groups are comparable.
struct Likeness {
  bool whole = true;               ///< all runs of the sweep have an answer
  std::uint64_t combinations = 0;  ///< otherwise: combinations of everything but the axis (0 if the design has none)
  std::uint64_t alike = 0;         ///< of these, answered in every group
};

/// One estimator's answers to one quantity, over all configurations.
struct Series {
  std::string quantity;
  std::string estimator;
  std::vector<GroupStatistics> groups;
  Likeness likeness = {};
};

/// Errors that may be compared from group to group; null if only those of unlike runs exist.
const ErrorStatistics* comparable(const Series& series, const GroupStatistics& group);

/// How the rows of `result` (s) and `run` (r) are grouped: an SQL expression.
struct Grouping {
  std::string expression = "0";
  double from = 0.0, to = 0.0;  ///< of the bins
  bool binned = false, logarithmic = false, words = false;
  bool switched = false;    ///< the words are false and true
  bool as_written = false;  ///< the words are files, two with the same name, distinguished by their folders
  /// Two SQL expressions for what must be answered in every group to be compared; empty if the design has none.
  std::string combination = {};
  std::uint64_t combinations = 0;  ///< their number, for one configuration
  std::uint64_t runs = 1;          ///< per combination in one group
  bool of_runs = false;            ///< a combination is a run, with all of its configurations
};

/// Groups by an axis' values, or by bins if these are many.
Grouping grouping_of(const Sweep& sweep, const Axis& axis, Database& database);
Grouping by_configuration(const Sweep& sweep);

/// For all configurations, if none is named. The groups come in rising order of the expression. `words`: the labels to
/// which positions refer; new ones are added.
std::vector<Series> series_of(Database& database, const Grouping& grouping, std::vector<std::string>& words,
                              const std::string& configuration = {});

/// By quantity and estimator: the number of configurations with a truth in some run.
using ConfigurationCounts = std::map<std::pair<std::string, std::string>, std::uint64_t>;
ConfigurationCounts configurations_of(Database& database);

/// Sets `likeness` of each series that series_of() gave with the same arguments, and `alike` of its groups.
void find_alike(const Sweep& sweep, Database& database, const Grouping& grouping, const ConfigurationCounts& counts,
                const std::string& configuration, std::vector<Series>& all);

/// Clip and configuration, alternating, by their names in the first run that did not fail; all runs have the same
/// names. Empty if there is none.
std::vector<std::string> clips_and_configurations(const Sweep& sweep, Database& database);

}  // namespace glidelab::validate
