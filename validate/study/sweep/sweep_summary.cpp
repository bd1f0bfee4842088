#include "validate/study/sweep/sweep_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdlib>
#include <functional>

#include "base/text/number_text.h"
#include "fit/estimators.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {
namespace {

constexpr int kMostReadableDigits = 6;  // significant digits that are still readable
constexpr int kShownDigits = 4;

bool digit_at(std::string_view text, std::size_t at) {
  return at < text.size() && base::is_digit(text[at]);
}

std::size_t behind_digits(std::string_view text, std::size_t at) {
  while (digit_at(text, at)) ++at;
  return at;
}

/// The position after the number that begins with a digit at `from`.
std::size_t behind_number(std::string_view text, std::size_t from) {
  std::size_t at = behind_digits(text, from);
  if (at < text.size() && text[at] == '.' && digit_at(text, at + 1)) at = behind_digits(text, at + 1);
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const bool sign = at + 1 < text.size() && (text[at + 1] == '-' || text[at + 1] == '+');
    const std::size_t power = at + (sign ? 2 : 1);
    if (digit_at(text, power)) at = behind_digits(text, power);
  }
  return at;
}

/// The text with each number replaced by that of `written`.
std::string rewritten(std::string_view text, const std::function<std::string(std::string_view)>& written) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const bool minus = text[at] == '-' && digit_at(text, at + 1) &&
                       (at == 0 || std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0);
    if (!minus && !digit_at(text, at)) {
      result += text[at++];
      continue;
    }
    const std::size_t end = behind_number(text, at + (minus ? 1 : 0));
    result += written(text.substr(at, end - at));
    at = end;
  }
  return result;
}

/// Digits before a power of ten, without leading zeros.
int significant_digits(std::string_view number) {
  int digits = 0;
  for (const char c : number.substr(0, number.find_first_of("eE"))) {
    if (c >= '0' && c <= '9' && (digits > 0 || c != '0')) ++digits;
  }
  return digits;
}

}  // namespace

void FailureKinds::add(const std::string& why) {
  FailureKind& kind = kinds_[without_numbers(why)];
  if (kind.runs == 0) kind.example = why;
  kind.one_text = kind.one_text && kind.example == why;
  ++kind.runs;
}

std::vector<FailureKind> FailureKinds::by_number() const {
  std::vector<FailureKind> kinds;
  for (const auto& [text, kind] : kinds_) kinds.push_back(kind);
  std::stable_sort(kinds.begin(), kinds.end(),
                   [](const FailureKind& a, const FailureKind& b) { return a.runs > b.runs; });
  return kinds;
}

std::string without_numbers(std::string_view text) {
  return rewritten(text, [](std::string_view) { return std::string("#"); });
}

std::string with_rounded_numbers(std::string_view text) {
  return rewritten(text, [](std::string_view number) {
    const bool whole = number.find_first_of(".eE") == std::string_view::npos;
    if (whole || significant_digits(number) <= kMostReadableDigits) return std::string(number);
    return base::number_text(std::strtod(std::string(number).c_str(), nullptr), kShownDigits);
  });
}

namespace {

/// The value below which the given fraction of a column lies, over `count` rows of one estimator.
std::optional<double> quantile_of(Database& database, const std::string& rows, const std::string& column,
                                  const std::string& estimator, std::uint64_t count, double part) {
  if (count == 0) return std::nullopt;
  SqlStatement select = database.prepare(fmt::format("SELECT {} {} ORDER BY 1 LIMIT 1 OFFSET ?2", column, rows));
  select.bind(1, std::string_view(estimator)).bind(2, static_cast<std::int64_t>(part * static_cast<double>(count - 1)));
  if (!select.step()) return std::nullopt;
  return select.maybe_number(0);
}

/// Errors for the clips of one configuration, or for all if none is named. `names` as from clips_and_configurations().
std::vector<AccelerationError> accelerations_of(Database& database, const std::vector<std::string>& names,
                                                const std::string& configuration) {
  std::string counted = "c.estimator = ?1 AND c.a_rms_error_m_s2 IS NOT NULL";
  if (!configuration.empty()) {
    std::string clips;  // their names have no apostrophes
    for (std::size_t i = 0; i + 1 < names.size(); i += 2) {
      if (names[i + 1] == configuration) clips += fmt::format("{}'{}'", clips.empty() ? "" : ", ", names[i]);
    }
    counted += " AND c.clip IN (" + clips + ")";
  }
  const std::string best = Analysis{std::string(fit::default_estimator().name), std::nullopt, kBestPossible}.name();
  const std::string alone = "FROM clip c WHERE " + counted;
  const std::string beside = fmt::format(
      "FROM clip c JOIN clip b ON b.run = c.run AND b.clip = c.clip AND b.estimator = '{}' "
      "WHERE {} AND b.a_rms_error_m_s2 > 0",
      best, counted);
  const auto rows_of = [&](const std::string& rows, const std::string& estimator) {
    SqlStatement count = database.prepare("SELECT count(*) " + rows);
    count.bind(1, std::string_view(estimator)).step();
    return static_cast<std::uint64_t>(count.integer(0));
  };
  std::vector<AccelerationError> all;
  SqlStatement estimators = database.prepare("SELECT DISTINCT estimator FROM clip ORDER BY estimator");
  while (estimators.step()) {
    AccelerationError of;
    of.configuration = configuration;
    of.estimator = estimators.text(0);
    of.clips = rows_of(alone, of.estimator);
    const auto median = quantile_of(database, alone, "c.a_rms_error_m_s2", of.estimator, of.clips, 0.5);
    if (!median) continue;  // it has no a(t)
    of.median_m_s2 = *median;
    const std::uint64_t pairs = rows_of(beside, of.estimator);
    const char* const ratio = "c.a_rms_error_m_s2 / b.a_rms_error_m_s2";
    of.regret = quantile_of(database, beside, ratio, of.estimator, pairs, 0.5);
    of.regret90 = quantile_of(database, beside, ratio, of.estimator, pairs, 0.9);
    all.push_back(std::move(of));
  }
  return all;
}

std::vector<ChosenBandwidth> bandwidths_of(Database& database) {
  const std::string rows = "FROM clip c WHERE c.estimator = ?1 AND c.bandwidth_s > 0";
  std::vector<ChosenBandwidth> all;
  SqlStatement estimators = database.prepare("SELECT DISTINCT estimator FROM clip ORDER BY estimator");
  while (estimators.step()) {
    const std::string estimator = estimators.text(0);
    SqlStatement count = database.prepare("SELECT count(*) " + rows);
    count.bind(1, std::string_view(estimator)).step();
    const auto clips = static_cast<std::uint64_t>(count.integer(0));
    const auto at = [&](double part) { return quantile_of(database, rows, "c.bandwidth_s", estimator, clips, part); };
    const std::optional<double> low = at(0.1), median = at(0.5), high = at(0.9);
    if (low && median && high) all.push_back({estimator, *median, *low, *high});
  }
  return all;
}

/// Errors of a scenario begin with its name and the varied values.
FailedRuns failures_of(const Sweep& sweep, Database& database, std::uint64_t failed) {
  constexpr std::size_t kShownKinds = 5;
  FailureKinds reasons;
  SqlStatement select = database.prepare("SELECT why FROM run WHERE status = 'failed' ORDER BY run");
  while (select.step()) reasons.add(select.text(0));
  const std::vector<FailureKind> kinds = reasons.by_number();
  const std::string file = sweep.scenario_file.string() + " with ";
  FailedRuns failures;
  failures.other_runs = failed;
  for (std::size_t k = 0; k < std::min(kinds.size(), kShownKinds); ++k) {
    const FailureKind& kind = kinds[k];
    const bool of_scenario = kind.example.starts_with(file);
    failures.kinds.push_back({kind.runs, kind.one_text, of_scenario,
                              with_rounded_numbers(of_scenario ? kind.example.substr(file.size()) : kind.example)});
    failures.other_runs -= kind.runs;
  }
  failures.other_kinds = kinds.size() - failures.kinds.size();
  return failures;
}

/// Empty if the scenario has one.
std::vector<ConfigurationSummary> by_configuration_of(const Sweep& sweep, Database& database,
                                                      const ConfigurationCounts& counts) {
  const Grouping grouping = by_configuration(sweep);
  std::vector<std::string> names;
  std::vector<Series> all = series_of(database, grouping, names);
  if (names.size() < 2) return {};
  find_alike(sweep, database, grouping, counts, {}, all);
  std::sort(names.begin(), names.end());
  std::vector<ConfigurationSummary> configurations;
  for (const std::string& name : names) {
    configurations.push_back({name, {}});
    for (const Series& series : all) {
      for (const GroupStatistics& group : series.groups) {
        if (group.label != name) continue;
        configurations.back().overall.push_back({series.quantity, series.estimator, {group}, series.likeness});
      }
    }
  }
  return configurations;
}

}  // namespace

namespace {

/// A failed run left every quantity undetermined for the same reason: those of one quantity are counted.
fit::OutsideTally outside_tally(const fit::OutsideEstimator& estimator, Database& database) {
  fit::OutsideTally tally = fit::tally_of(estimator, {});
  SqlStatement runs = database.prepare("SELECT count(DISTINCT run) FROM result WHERE estimator = ?1");
  runs.bind(1, std::string_view(estimator.name));
  runs.step();
  tally.runs = static_cast<std::size_t>(runs.integer(0));
  SqlStatement failed = database.prepare(
      "SELECT count(DISTINCT run), min(run), why FROM result WHERE estimator = ?1 AND substr(why, 1, length(?2)) = ?2");
  for (std::size_t i = 0; i < fit::kOutsideFailures.size(); ++i) {
    const std::string begins = fit::why_begins(fit::kOutsideFailures[i]);
    failed.bind(1, std::string_view(estimator.name)).bind(2, std::string_view(begins));
    if (failed.step() && failed.integer(0) > 0) {
      tally.failures[i] = {static_cast<std::size_t>(failed.integer(0)), failed.text(2).substr(begins.size() + 2)};
    }
    failed.reset();
  }
  return tally;
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
  summary.failures = failures_of(sweep, database, summary.failed);
  SqlStatement timing = database.prepare("SELECT total(wall_s) FROM timing");
  timing.step();
  summary.cpu_s = timing.number(0);
  if (sweep.outside) summary.outside = outside_tally(*sweep.outside, database);
  std::vector<std::string> no_words;
  summary.overall = series_of(database, {}, no_words);
  const ConfigurationCounts with_truth = configurations_of(database);
  summary.configurations = by_configuration_of(sweep, database, with_truth);
  for (const Axis& axis : sweep.axes) {
    const Grouping grouping = grouping_of(sweep, axis, database);
    AxisSummary of_axis;
    of_axis.name = axis.name;
    of_axis.words = grouping.words;
    of_axis.logarithmic = grouping.logarithmic;
    const auto series = [&](const std::string& configuration) {
      std::vector<Series> all = series_of(database, grouping, of_axis.labels, configuration);
      find_alike(sweep, database, grouping, with_truth, configuration, all);
      return all;
    };
    of_axis.series = series({});
    if (summary.configurations.size() <= kMostSplit) {
      for (const ConfigurationSummary& of : summary.configurations) {
        of_axis.of_configurations.push_back(series(of.name));
      }
    }
    SqlStatement unit = database.prepare("SELECT unit FROM \"schema\" WHERE \"table\" = 'run' AND \"column\" = ?1");
    unit.bind(1, std::string_view(axis.name));
    if (unit.step()) of_axis.unit = unit.text(0);
    summary.axes.push_back(std::move(of_axis));
  }
  const std::vector<std::string> clips = clips_and_configurations(sweep, database);
  summary.accelerations = accelerations_of(database, clips, {});
  for (ConfigurationSummary& of : summary.configurations) {
    of.accelerations = accelerations_of(database, clips, of.name);
  }
  summary.bandwidths = bandwidths_of(database);
  summary.masses = study_masses(sweep, database);
  return summary;
}

}  // namespace glidelab::validate
