/// What a sweep's database says: of every quantity and estimator, error, stated and least sd over each varied key.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/mass_study.h"
#include "validate/study/sweep/sweep_database.h"

namespace glidelab::validate {

/// Over the runs of one group. Standard deviations and bounds are root mean squares.
struct ErrorStatistics {
  std::uint64_t runs = 0;      ///< with a truth
  std::uint64_t answered = 0;  ///< of these, with a value
  double bias = 0.0;           ///< mean error
  double bias_sd = 0.0;        ///< standard error of it
  double rms = 0.0;            ///< root mean square error
  double sd = 0.0;             ///< as stated
  std::optional<double> least_sd;
  double coverage = 0.0;  ///< part of the 95 % intervals that hold the truth
};

struct GroupStatistics {
  std::string label;      ///< of the value or the bin, for a table
  double position = 0.0;  ///< on a plot's axis: the value, the middle of the bin, or a number for a word
  ErrorStatistics statistics;
  /// Over the combinations of all else that are answered in every group (validate/sweep_groups.h); nothing where all
  /// runs have an answer, and where there are none.
  std::optional<ErrorStatistics> alike = {};
};

/// Whether what is in one group is like what is in the others.
struct Likeness {
  bool whole = true;               ///< all runs of the sweep have an answer
  std::uint64_t combinations = 0;  ///< else: of all but the axis (0 where the design has none)
  std::uint64_t alike = 0;         ///< of these, answered in every group
};

/// One estimator's answers to one quantity, over all configurations.
struct Series {
  std::string quantity;
  std::string estimator;
  std::vector<GroupStatistics> groups;
  Likeness likeness = {};
};

/// Errors that may be compared from group to group; null where those of unlike runs are all there is.
const ErrorStatistics* comparable(const Series& series, const GroupStatistics& group);

/// Configurations of which plots apart are readable.
inline constexpr std::size_t kMostSplit = 4;

/// Over the values of one axis, all others mixed.
struct AxisSummary {
  std::string name;
  std::string unit;
  bool words = false;               ///< positions are numbers of labels
  bool logarithmic = false;         ///< better plotted so
  std::vector<std::string> labels;  ///< of words
  std::vector<Series> series;
  /// As SweepSummary::configurations has them, where there are at most kMostSplit; else empty.
  std::vector<std::vector<Series>> of_configurations = {};
};

/// How far from the truth one method's a(t) is: root mean squares over a clip's points that count, clip by clip beside
/// the best possible bandwidth's on the same clip.
struct AccelerationError {
  std::string configuration;  ///< empty: of all
  std::string estimator;
  std::uint64_t clips = 0;
  double median_m_s2 = 0.0;
  std::optional<double> regret, regret90;  ///< error over the best possible one: median, and what 90 % stay below
};

/// One configuration of the scenario: the same over its runs alone.
struct ConfigurationSummary {
  std::string name;
  std::vector<Series> overall;  ///< each of one group, with the likeness of the configurations
  std::vector<AccelerationError> accelerations = {};
};

struct SweepSummary {
  std::string name;
  std::uint64_t runs = 0, planned = 0, failed = 0;
  /// The five commonest kinds of reasons (failure_kinds.h), with how often and one of each; how many more.
  std::vector<std::string> failures;
  double cpu_s = 0.0;                                ///< wall time of all runs on their threads
  std::vector<Series> overall;                       ///< each of one group
  std::vector<ConfigurationSummary> configurations;  ///< by their names; empty where the scenario has one
  std::vector<AxisSummary> axes;
  std::vector<AccelerationError> accelerations;
  MassStudy masses;
};

/// Of the runs that are there. InputError, EnvironmentError as of the database (sqlite.h).
SweepSummary summarize(const Sweep& sweep, Database& database);

}  // namespace glidelab::validate
