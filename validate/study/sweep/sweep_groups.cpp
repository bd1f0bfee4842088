#include "validate/study/sweep/sweep_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <variant>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"

namespace glidelab::validate {
namespace {

constexpr std::size_t kMostGroups = 40;  // values of an axis that are kept separate; more are put into bins
constexpr int kBins = 12;

/// Statistics of the rows of a group or a combination.
constexpr const char* kStatistics =
    "count(*), count(s.value), avg(s.value - s.truth), avg((s.value - s.truth) * (s.value - s.truth)), "
    "avg(s.sd * s.sd), avg(s.least_sd * s.least_sd), "
    "avg(CASE WHEN s.low95 IS NULL THEN NULL ELSE s.truth >= s.low95 AND s.truth <= s.high95 END), "
    "avg((s.value - s.truth) / s.sd), avg((s.value - s.truth) * (s.value - s.truth) / (s.sd * s.sd)) "
    "FROM result s JOIN run r ON r.run = s.run WHERE s.truth IS NOT NULL AND (?1 = '' OR s.configuration = ?1)";

/// Means over rows.
struct Moments {
  std::uint64_t runs = 0, answered = 0;
  double error = 0.0, square = 0.0, variance = 0.0, coverage = 0.0;
  std::optional<double> least_variance;
  std::optional<double> in_sds, square_in_sds;  // the error over its stated standard deviation
};

/// The columns of kStatistics, from the given one.
Moments moments_at(const SqlStatement& row, int column) {
  return {static_cast<std::uint64_t>(row.integer(column)),
          static_cast<std::uint64_t>(row.integer(column + 1)),
          row.number(column + 2),
          row.number(column + 3),
          row.number(column + 4),
          row.number(column + 6),
          row.maybe_number(column + 5),
          row.maybe_number(column + 7),
          row.maybe_number(column + 8)};
}

ErrorStatistics statistics_of(const Moments& of) {
  ErrorStatistics statistics;
  statistics.runs = of.runs;
  statistics.answered = of.answered;
  statistics.bias = of.error;
  statistics.rms = std::sqrt(of.square);
  if (of.in_sds && of.square_in_sds) {
    statistics.in_stated_sds = ErrorStatistics::InStatedSds{*of.in_sds, 0.0, std::sqrt(*of.square_in_sds), 0.0};
  }
  if (of.answered > 1) {
    const auto count = static_cast<double>(of.answered);
    statistics.bias_sd = std::sqrt(std::max(0.0, of.square - of.error * of.error) / (count - 1.0));
    if (auto& sds = statistics.in_stated_sds) {
      sds->mean_sd = std::sqrt(std::max(0.0, sds->rms * sds->rms - sds->mean * sds->mean) / (count - 1.0));
      sds->rms_sd = sds->rms / std::sqrt(2.0 * count);
    }
  }
  statistics.sd = std::sqrt(of.variance);
  if (of.least_variance) statistics.least_sd = std::sqrt(*of.least_variance);
  statistics.coverage = of.coverage;
  return statistics;
}

/// The name of a file without folder and extension.
std::string label_of_word(const std::string& word) {
  const std::filesystem::path path(word);
  return path.extension() == ".toml" ? path.stem().string() : word;
}

bool are_labels_alike(const std::vector<base::TomlScalar>& values) {
  std::set<std::string> labels;
  return std::any_of(values.begin(), values.end(), [&](const base::TomlScalar& value) {
    const std::string* word = std::get_if<std::string>(&value);
    return word != nullptr && !labels.insert(label_of_word(*word)).second;
  });
}

std::string label_of(const Grouping& grouping, const std::string& word) {
  if (grouping.switched) return word == "1" ? "true" : "false";
  return grouping.of_runs || grouping.as_written ? word : label_of_word(word);
}

double middle_of_bin(const Grouping& grouping, double bin) {
  const double part = (bin + 0.5) / kBins;
  return grouping.logarithmic ? grouping.from * std::pow(grouping.to / grouping.from, part)
                              : grouping.from + (grouping.to - grouping.from) * part;
}

/// Label and position of a row's group.
GroupStatistics group_at(const Grouping& grouping, const SqlStatement& row, int column,
                         std::vector<std::string>& words) {
  GroupStatistics group;
  if (grouping.words) {
    group.label = label_of(grouping, row.text(column));
    auto found = std::find(words.begin(), words.end(), group.label);
    if (found == words.end()) found = words.insert(words.end(), group.label);
    group.position = static_cast<double>(found - words.begin());
  } else {
    group.position = grouping.binned ? middle_of_bin(grouping, row.number(column)) : row.number(column);
    group.label = fmt::format("{:.5g}", group.position);
  }
  return group;
}

bool any_drawn(const Sweep& sweep) {
  return sweep.design != Design::factorial ||
         std::any_of(sweep.axes.begin(), sweep.axes.end(), [](const Axis& axis) { return axis.source.drawn(); });
}

/// A factorial point is a number whose digits are the indices of the axes' values: without the digit of this axis it is
/// the combination of the others.
void set_combination(const Sweep& sweep, const Axis& axis, Grouping& grouping) {
  if (any_drawn(sweep)) return;
  std::uint64_t below = 1;
  for (std::size_t i = sweep.axes.size(); i-- > 0 && &sweep.axes[i] != &axis;) {
    below *= all_values(sweep.axes[i].source).size();
  }
  const std::uint64_t values = all_values(axis.source).size();
  grouping.combination = fmt::format("(r.point / {0}) * {1} + r.point % {1}, s.configuration", below * values, below);
  grouping.combinations = point_count(sweep) / values;
  grouping.runs = sweep.replicates;
}

/// Sums of one group over the compared combinations.
struct Sum {
  Moments total;
  std::uint64_t combinations = 0, with_least = 0, with_sds = 0;
  void add(const Moments& of) {
    ++combinations;
    total.runs += of.runs;
    total.answered += of.answered;
    total.error += of.error;
    total.square += of.square;
    total.variance += of.variance;
    total.coverage += of.coverage;
    if (of.in_sds && of.square_in_sds) {
      ++with_sds;
      total.in_sds = total.in_sds.value_or(0.0) + *of.in_sds;
      total.square_in_sds = total.square_in_sds.value_or(0.0) + *of.square_in_sds;
    }
    if (!of.least_variance) return;
    ++with_least;
    total.least_variance = total.least_variance.value_or(0.0) + *of.least_variance;
  }
  Moments mean() const {
    Moments mean = total;
    const auto count = static_cast<double>(combinations);
    for (double* const part : {&mean.error, &mean.square, &mean.variance, &mean.coverage}) *part /= count;
    for (auto* const part : {&mean.in_sds, &mean.square_in_sds}) {
      if (*part) **part /= static_cast<double>(with_sds);
    }
    if (mean.least_variance) *mean.least_variance /= static_cast<double>(with_least);
    return mean;
  }
};

/// Reads the rows of one series, combination by combination, and keeps only sums by group: it works for a sweep of any
/// length.
class AlikeRuns {
 public:
  AlikeRuns(const Grouping& grouping, Series& series)
      : grouping_(grouping), series_(series), sums_(series.groups.size()) {
    for (const GroupStatistics& group : series.groups) wanted_ += group.statistics.answered > 0 ? 1 : 0;
  }
  void add(const std::string& combination, const GroupStatistics& at, const Moments& of) {
    if (combination != combination_) end_combination();
    combination_ = combination;
    if (of.answered == 0 || 2 * of.answered < grouping_.runs) return;
    const auto found = std::find_if(series_.groups.begin(), series_.groups.end(), [&](const GroupStatistics& group) {
      return grouping_.words ? group.label == at.label : group.position == at.position;
    });
    here_.emplace_back(static_cast<std::size_t>(found - series_.groups.begin()), of);
  }
  void finish() {
    end_combination();
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      if (sums_[i].combinations > 0) series_.groups[i].alike = statistics_of(sums_[i].mean());
    }
  }

 private:
  void end_combination() {
    if (!here_.empty() && here_.size() == wanted_) {
      for (const auto& [group, of] : here_) sums_.at(group).add(of);
      ++series_.likeness.alike;
    }
    here_.clear();
  }

  const Grouping& grouping_;
  Series& series_;
  std::vector<Sum> sums_;
  std::string combination_;
  std::vector<std::pair<std::size_t, Moments>> here_;  // for this combination: the group's number and its moments
  std::size_t wanted_ = 0;
};

/// Finds comparable statistics for those series whose runs do not all have an answer.
void take_alike(Database& database, const Grouping& grouping, const std::string& configuration,
                std::vector<Series>& all) {
  SqlStatement select = database.prepare(
      fmt::format("SELECT s.quantity, s.estimator, {}, {} AS g, {} GROUP BY 1, 2, 3, 4, g ORDER BY 1, 2, 3, 4, g",
                  grouping.combination, grouping.expression, kStatistics));
  select.bind(1, std::string_view(configuration));
  std::vector<std::string> words;
  std::optional<AlikeRuns> runs;
  auto series = all.end();
  while (select.step()) {
    const std::string quantity = select.text(0), estimator = select.text(1);
    if (series == all.end() || series->quantity != quantity || series->estimator != estimator) {
      if (runs) runs->finish();
      runs.reset();
      series = std::find_if(all.begin(), all.end(),
                            [&](const Series& of) { return of.quantity == quantity && of.estimator == estimator; });
      if (!series->likeness.whole) runs.emplace(grouping, *series);
    }
    if (!runs) continue;
    const std::string combination = fmt::format("{}\n{}", select.integer(2), select.text(3));
    runs->add(combination, group_at(grouping, select, 4, words), moments_at(select, 5));
  }
  if (runs) runs->finish();
}

}  // namespace

const ErrorStatistics* comparable(const Series& series, const GroupStatistics& group) {
  if (series.likeness.whole) return &group.statistics;
  return group.alike ? &*group.alike : nullptr;
}

Grouping grouping_of(const Sweep& sweep, const Axis& axis, Database& database) {
  using Kind = AxisSource::Kind;
  Grouping grouping;
  const std::string column = "r." + sql_name(axis.name);
  grouping.expression = column;
  set_combination(sweep, axis, grouping);
  const AxisSource& source = axis.source;
  grouping.words = source.kind == Kind::list && !std::holds_alternative<double>(source.values.front());
  grouping.switched = source.kind == Kind::list && std::holds_alternative<bool>(source.values.front());
  grouping.as_written = grouping.words && are_labels_alike(source.values);
  if (grouping.words) return grouping;
  SqlStatement select = database.prepare(
      fmt::format("SELECT count(DISTINCT {0}), min({0}), max({0}) FROM run r WHERE status = 'done'", column));
  select.step();
  grouping.from = select.number(1);
  grouping.to = select.number(2);
  const bool ratio =
      source.kind == Kind::logarithmic || source.kind == Kind::log_uniform || source.kind == Kind::log_normal;
  grouping.logarithmic = grouping.from > 0.0 && (ratio || grouping.to / grouping.from > 20.0);
  if (static_cast<std::size_t>(select.integer(0)) <= kMostGroups) return grouping;
  grouping.binned = true;
  const std::string place =
      grouping.logarithmic
          ? fmt::format("ln({} / {:.17g}) / {:.17g}", column, grouping.from, std::log(grouping.to / grouping.from))
          : fmt::format("({} - ({:.17g})) / {:.17g}", column, grouping.from, grouping.to - grouping.from);
  grouping.expression = fmt::format("min({}, CAST({} * ({}) AS INTEGER))", kBins - 1, kBins, place);
  return grouping;
}

Grouping by_configuration(const Sweep& sweep) {
  Grouping grouping;
  grouping.expression = "s.configuration";
  grouping.words = true;
  grouping.combination = "r.run, ''";
  grouping.combinations = run_count(sweep);
  grouping.of_runs = true;
  return grouping;
}

std::vector<Series> series_of(Database& database, const Grouping& grouping, std::vector<std::string>& words,
                              const std::string& configuration) {
  SqlStatement select =
      database.prepare(fmt::format("SELECT s.quantity, s.estimator, {} AS g, {} GROUP BY s.quantity, s.estimator, g "
                                   "ORDER BY s.quantity, s.estimator, g",
                                   grouping.expression, kStatistics));
  select.bind(1, std::string_view(configuration));
  std::vector<Series> all;
  while (select.step()) {
    const std::string quantity = select.text(0), estimator = select.text(1);
    if (all.empty() || all.back().quantity != quantity || all.back().estimator != estimator) {
      all.push_back({quantity, estimator, {}});
    }
    all.back().groups.push_back(group_at(grouping, select, 2, words));
    all.back().groups.back().statistics = statistics_of(moments_at(select, 3));
  }
  return all;
}

ConfigurationCounts configurations_of(Database& database) {
  ConfigurationCounts counts;
  SqlStatement select = database.prepare(
      "SELECT quantity, estimator, count(DISTINCT configuration) FROM result WHERE truth IS NOT NULL GROUP BY 1, 2");
  while (select.step()) counts[{select.text(0), select.text(1)}] = static_cast<std::uint64_t>(select.integer(2));
  return counts;
}

std::vector<std::string> clips_and_configurations(const Sweep& sweep, Database& database) {
  std::vector<std::string> names;
  SqlStatement first = database.prepare("SELECT min(run) FROM run WHERE status = 'done'");
  if (!first.step() || first.is_null(0)) return names;
  const RunScenario run = scenario_with(sweep, values_of(sweep, static_cast<std::uint64_t>(first.integer(0))));
  for (const sim::ConfigurationSetup& configuration : run.scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      names.insert(names.end(), {motion.name, configuration.name});
    }
  }
  return names;
}

void find_alike(const Sweep& sweep, Database& database, const Grouping& grouping, const ConfigurationCounts& counts,
                const std::string& configuration, std::vector<Series>& all) {
  bool whole = true;
  for (Series& series : all) {
    const std::uint64_t configurations = configuration.empty() ? counts.at({series.quantity, series.estimator}) : 1;
    std::uint64_t answered = 0;
    for (const GroupStatistics& group : series.groups) answered += group.statistics.answered;
    series.likeness.whole = answered == configurations * run_count(sweep);
    whole = whole && series.likeness.whole;
    if (!series.likeness.whole)
      series.likeness.combinations = grouping.combinations * (grouping.of_runs ? 1 : configurations);
  }
  if (!whole && !grouping.combination.empty()) take_alike(database, grouping, configuration, all);
}

}  // namespace glidelab::validate
