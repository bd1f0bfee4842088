#include "validate/sweep_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "validate/sweep_design.h"

namespace glidelab::validate {
namespace {

constexpr std::size_t kMostGroups = 40;  // values of an axis that stand for themselves; more are put in bins
constexpr int kBins = 12;

/// How the rows are put together: an SQL expression of the axis' column.
struct Grouping {
  std::string expression = "0";
  double from = 0.0, to = 0.0;  ///< of the bins
  bool binned = false, logarithmic = false, words = false;
};

std::string label_of_word(const std::string& word) {
  const std::filesystem::path path(word);
  return path.extension() == ".toml" ? path.stem().string() : word;
}

Grouping grouping_of(const Axis& axis, Database& database) {
  using Kind = AxisSource::Kind;
  Grouping grouping;
  const std::string column = "r." + sql_name(axis.name);
  grouping.expression = column;
  const AxisSource& source = axis.source;
  grouping.words = source.kind == Kind::list && !std::holds_alternative<double>(source.values.front());
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

double middle_of_bin(const Grouping& grouping, double bin) {
  const double part = (bin + 0.5) / kBins;
  return grouping.logarithmic ? grouping.from * std::pow(grouping.to / grouping.from, part)
                              : grouping.from + (grouping.to - grouping.from) * part;
}

/// The groups come in rising order of the expression. Of all configurations, where none is named.
std::vector<Series> series_of(Database& database, const Grouping& grouping, std::vector<std::string>& words,
                              const std::string& configuration = {}) {
  SqlStatement select = database.prepare(fmt::format(
      "SELECT s.quantity, s.estimator, {} AS g, count(*), count(s.value), avg(s.value - s.truth), "
      "avg((s.value - s.truth) * (s.value - s.truth)), avg(s.sd * s.sd), avg(s.least_sd * s.least_sd), "
      "avg(CASE WHEN s.low95 IS NULL THEN NULL ELSE s.truth >= s.low95 AND s.truth <= s.high95 END) "
      "FROM result s JOIN run r ON r.run = s.run WHERE s.truth IS NOT NULL AND (?1 = '' OR s.configuration = ?1) "
      "GROUP BY s.quantity, s.estimator, g ORDER BY s.quantity, s.estimator, g",
      grouping.expression));
  select.bind(1, std::string_view(configuration));
  std::vector<Series> all;
  while (select.step()) {
    const std::string quantity = select.text(0), estimator = select.text(1);
    if (all.empty() || all.back().quantity != quantity || all.back().estimator != estimator) {
      all.push_back({quantity, estimator, {}});
    }
    GroupStatistics group;
    if (grouping.words) {
      group.label = label_of_word(select.text(2));
      auto found = std::find(words.begin(), words.end(), group.label);
      if (found == words.end()) found = words.insert(words.end(), group.label);
      group.position = static_cast<double>(found - words.begin());
    } else {
      group.position = grouping.binned ? middle_of_bin(grouping, select.number(2)) : select.number(2);
      group.label = fmt::format("{:.5g}", group.position);
    }
    ErrorStatistics& of = group.statistics;
    of.runs = static_cast<std::uint64_t>(select.integer(3));
    of.answered = static_cast<std::uint64_t>(select.integer(4));
    const double count = static_cast<double>(of.answered);
    of.bias = select.number(5);
    const double square = select.number(6);
    of.rms = std::sqrt(square);
    if (of.answered > 1) of.bias_sd = std::sqrt(std::max(0.0, square - of.bias * of.bias) / (count - 1.0));
    of.sd = std::sqrt(select.number(7));
    if (const auto least = select.maybe_number(8)) of.least_sd = std::sqrt(*least);
    of.coverage = select.number(9);
    all.back().groups.push_back(std::move(group));
  }
  return all;
}

/// The value below which the given part of a column lies, of `count` rows of one estimator.
std::optional<double> quantile_of(Database& database, const std::string& rows, const std::string& column,
                                  const std::string& estimator, std::uint64_t count, double part) {
  if (count == 0) return std::nullopt;
  SqlStatement select = database.prepare(fmt::format("SELECT {} {} ORDER BY 1 LIMIT 1 OFFSET ?2", column, rows));
  select.bind(1, std::string_view(estimator)).bind(2, static_cast<std::int64_t>(part * static_cast<double>(count - 1)));
  if (!select.step()) return std::nullopt;
  return select.maybe_number(0);
}

std::vector<AccelerationError> accelerations_of(Database& database) {
  const std::string best = Analysis{"phase-diagram", std::nullopt, kBestPossible}.name();
  const std::string alone = "FROM clip c WHERE c.estimator = ?1 AND c.a_rms_error_m_s2 IS NOT NULL";
  const std::string beside = fmt::format(
      "FROM clip c JOIN clip b ON b.run = c.run AND b.clip = c.clip AND b.estimator = '{}' "
      "WHERE c.estimator = ?1 AND c.a_rms_error_m_s2 IS NOT NULL AND b.a_rms_error_m_s2 > 0",
      best);
  const auto rows_of = [&](const std::string& rows, const std::string& estimator) {
    SqlStatement count = database.prepare("SELECT count(*) " + rows);
    count.bind(1, std::string_view(estimator)).step();
    return static_cast<std::uint64_t>(count.integer(0));
  };
  std::vector<AccelerationError> all;
  SqlStatement names = database.prepare("SELECT DISTINCT estimator FROM clip ORDER BY estimator");
  while (names.step()) {
    AccelerationError of;
    of.estimator = names.text(0);
    of.clips = rows_of(alone, of.estimator);
    if (const auto median = quantile_of(database, alone, "c.a_rms_error_m_s2", of.estimator, of.clips, 0.5)) {
      of.median_m_s2 = *median;
    }
    const std::uint64_t pairs = rows_of(beside, of.estimator);
    const char* const ratio = "c.a_rms_error_m_s2 / b.a_rms_error_m_s2";
    of.regret = quantile_of(database, beside, ratio, of.estimator, pairs, 0.5);
    of.regret90 = quantile_of(database, beside, ratio, of.estimator, pairs, 0.9);
    all.push_back(std::move(of));
  }
  return all;
}

}  // namespace

SweepSummary summarize(const Sweep& sweep, Database& database) {
  SweepSummary summary;
  summary.name = sweep.name;
  summary.planned = run_count(sweep);
  SqlStatement counts = database.prepare("SELECT count(*), total(status = 'failed') FROM run");
  counts.step();
  summary.runs = static_cast<std::uint64_t>(counts.integer(0));
  summary.failed = static_cast<std::uint64_t>(counts.integer(1));
  SqlStatement reasons = database.prepare(
      "SELECT why, count(*) AS n FROM run WHERE status = 'failed' GROUP BY why ORDER BY n DESC, why LIMIT 5");
  while (reasons.step()) summary.failures.push_back(fmt::format("{} x {}", reasons.integer(1), reasons.text(0)));
  SqlStatement timing = database.prepare("SELECT total(wall_s) FROM timing");
  timing.step();
  summary.cpu_s = timing.number(0);
  std::vector<std::string> no_words;
  summary.overall = series_of(database, {}, no_words);
  SqlStatement names = database.prepare("SELECT DISTINCT configuration FROM result ORDER BY configuration");
  while (names.step()) summary.configurations.push_back({names.text(0), {}});
  if (summary.configurations.size() == 1) summary.configurations.clear();
  for (ConfigurationSummary& of : summary.configurations) of.overall = series_of(database, {}, no_words, of.name);
  for (const Axis& axis : sweep.axes) {
    const Grouping grouping = grouping_of(axis, database);
    AxisSummary of_axis;
    of_axis.name = axis.name;
    of_axis.words = grouping.words;
    of_axis.logarithmic = grouping.logarithmic;
    of_axis.series = series_of(database, grouping, of_axis.labels);
    if (summary.configurations.size() <= kMostSplit) {
      for (const ConfigurationSummary& of : summary.configurations) {
        of_axis.of_configurations.push_back(series_of(database, grouping, of_axis.labels, of.name));
      }
    }
    SqlStatement unit = database.prepare("SELECT unit FROM \"schema\" WHERE \"table\" = 'run' AND \"column\" = ?1");
    unit.bind(1, std::string_view(axis.name));
    if (unit.step()) of_axis.unit = unit.text(0);
    summary.axes.push_back(std::move(of_axis));
  }
  summary.accelerations = accelerations_of(database);
  summary.masses = study_masses(sweep, database);
  return summary;
}

}  // namespace glidelab::validate
