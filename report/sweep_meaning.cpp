#include "report/sweep_meaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "report/html.h"
#include "report/number_text.h"
#include "report/quantity_names.h"
#include "report/sweep_advice.h"

namespace glidelab::report {
namespace {

using validate::ErrorStatistics;
using validate::GroupStatistics;
using validate::Series;
using validate::SweepSummary;

bool knows_truth(const std::string& estimator) {
  return estimator.ends_with(validate::kBestPossible);
}

/// Of one group each: the least rms error among those that answer.
const Series* best_of(const std::vector<Series>& all, std::string_view quantity) {
  std::uint64_t most = 0;
  for (const Series& series : all) {
    if (series.quantity == quantity) most = std::max(most, series.groups.front().statistics.answered);
  }
  const Series* best = nullptr;
  for (const Series& series : all) {
    const ErrorStatistics& of = series.groups.front().statistics;
    if (series.quantity != quantity || knows_truth(series.estimator) || of.answered == 0) continue;
    if (static_cast<double>(of.answered) < kAnswers * static_cast<double>(most)) continue;
    if (best == nullptr || of.rms < best->groups.front().statistics.rms) best = &series;
  }
  return best;
}

const Series* series_of(const std::vector<Series>& all, const Series& like) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Series& series) {
    return series.quantity == like.quantity && series.estimator == like.estimator;
  });
  return found == all.end() ? nullptr : &*found;
}

std::string with_unit(double value, std::string_view quantity) {
  const std::string unit = unit_of(quantity);
  return number_text(value, 2) + (unit.empty() ? "" : (unit == "°" ? "" : " ") + unit);
}

std::string at_text(const validate::AxisSummary& axis, const GroupStatistics& group) {
  return axis.words ? escape(group.label) : number_text(group.position, 3);
}

/// "over 4 of 6 combinations of the other keys", where not all have an answer.
std::string part_of(const validate::Likeness& of, std::string_view what) {
  if (of.whole || of.alike == of.combinations) return {};
  return fmt::format(" (over those {} of {} {})", of.alike, of.combinations, what);
}

/// "rate is 0.001 1/s at 500 and 0.004 1/s at 31.2, 4 times as much"; empty where one value has answers or none errs.
std::string span_of(const validate::AxisSummary& axis, const Series& series) {
  const GroupStatistics *least = nullptr, *most = nullptr;
  const auto rms = [&](const GroupStatistics& of) { return validate::comparable(series, of)->rms; };
  for (const GroupStatistics& group : series.groups) {
    const ErrorStatistics* const of = validate::comparable(series, group);
    if (of == nullptr || of->answered == 0) continue;
    if (least == nullptr || of->rms < rms(*least)) least = &group;
    if (most == nullptr || of->rms > rms(*most)) most = &group;
  }
  if (least == most || !(rms(*least) > 0.0)) return {};
  return fmt::format(
      "{}{} is {} at {} and {} at {}, {} times as much", escape(axis.name),
      part_of(series.likeness, "combinations of the other keys and configurations that have an answer at each value"),
      with_unit(rms(*least), series.quantity), at_text(axis, *least), with_unit(rms(*most), series.quantity),
      at_text(axis, *most), number_text(rms(*most) / rms(*least), 2));
}

bool answered_at_two(const Series& series) {
  return std::count_if(series.groups.begin(), series.groups.end(),
                       [](const GroupStatistics& group) { return group.statistics.answered > 0; }) > 1;
}

/// "turning: 0.0001; straight: 0.0002": where each run has both, or over those that have.
std::string configurations_of(const SweepSummary& summary, const Series& best) {
  std::string text, part;
  for (const validate::ConfigurationSummary& of : summary.configurations) {
    const Series* const series = series_of(of.overall, best);
    if (series == nullptr) continue;
    const ErrorStatistics* const errors = validate::comparable(*series, series->groups.front());
    if (errors == nullptr || errors->answered == 0) continue;
    part = part_of(series->likeness, "runs in which each configuration has an answer");
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", escape(of.name), with_unit(errors->rms, best.quantity));
  }
  return text + part;
}

/// Of one quantity over the keys and the configurations.
std::string changes_of(const SweepSummary& summary, const Series& best) {
  std::string text, unlike;
  bool drawn = false;
  for (const validate::AxisSummary& axis : summary.axes) {
    const Series* const series = series_of(axis.series, best);
    if (series == nullptr) continue;
    const std::string span = span_of(axis, *series);
    if (!span.empty()) text += fmt::format("{}along {}", text.empty() ? "" : "; ", span);
    const validate::Likeness& of = series->likeness;
    if (of.whole || of.alike > 0 || !answered_at_two(*series)) continue;
    unlike += (unlike.empty() ? "" : ", ") + escape(axis.name);
    drawn = of.combinations == 0;
  }
  const std::string configurations = configurations_of(summary, best);
  if (!configurations.empty()) text += (text.empty() ? "" : "; ") + configurations;
  if (!text.empty()) text = fmt::format(" The rms error of {} {}.", symbol_of(best.quantity), text);
  if (!unlike.empty()) {
    text += fmt::format(" Along {} it is not compared: some runs have no answer, and {}.", unlike,
                        drawn ? "with drawn values those that have are not alike at two values of a key"
                              : "no combination of the other keys has one at each value");
  }
  return text;
}

/// "K/m, µ by trajectory (80 to 88 %)": of each estimator its quantities, of many estimators the first.
std::string list_of(const std::vector<const Series*>& all) {
  std::string text;
  constexpr std::size_t kMost = 4;  // estimators that a paragraph can name
  std::size_t estimators = 0;
  for (std::size_t i = 0; i < all.size();) {
    std::string quantities;
    double least = 100.0, most = 0.0;
    const std::string& estimator = all[i]->estimator;
    for (; i < all.size() && all[i]->estimator == estimator; ++i) {
      quantities += (quantities.empty() ? "" : ", ") + symbol_of(all[i]->quantity);
      least = std::min(least, 100.0 * all[i]->groups.front().statistics.coverage);
      most = std::max(most, all[i]->groups.front().statistics.coverage * 100.0);
    }
    if (++estimators > kMost) continue;
    const std::string from = fmt::format("{:.0f}", least), to = fmt::format("{:.0f}", most);
    text += fmt::format("{}{} by {} ({} %)", text.empty() ? "" : "; ", quantities, escape(estimator),
                        from == to ? from : fmt::format("{} to {}", from, to));
  }
  if (estimators > kMost) text += fmt::format("; and {} more in the table", estimators - kMost);
  return text;
}

/// Intervals that hold the truth in another part of the runs than 95 %.
std::string intervals(const SweepSummary& summary) {
  std::vector<const Series*> narrow, wide;
  for (const Series& series : summary.overall) {
    const ErrorStatistics& of = series.groups.front().statistics;
    if (of.answered == 0 || !(of.sd > 0.0)) continue;
    const double se = std::sqrt(0.95 * 0.05 / static_cast<double>(of.answered));
    if (std::abs(of.coverage - 0.95) > 3.0 * se) (of.coverage < 0.95 ? narrow : wide).push_back(&series);
  }
  std::string text;
  for (std::vector<const Series*>* const list : {&narrow, &wide}) {
    std::stable_sort(list->begin(), list->end(),
                     [](const Series* x, const Series* y) { return x->estimator < y->estimator; });
  }
  if (!narrow.empty()) text += fmt::format(" Intervals of 95 % that hold the truth less often: {}.", list_of(narrow));
  if (!wide.empty()) {
    text += fmt::format("{} more often: {}.", narrow.empty() ? " Intervals of 95 % that hold the truth" : " And",
                        list_of(wide));
  }
  return text.empty() ? " All stated 95 % intervals hold the truth as often as they say, within three standard errors."
                      : text;
}

}  // namespace

std::string sweep_meaning(const SweepSummary& summary) {
  std::string text, who;
  const Series* first = nullptr;
  for (const QuantityName& quantity : kQuantities) {
    const Series* const best = best_of(summary.overall, quantity.key);
    if (best == nullptr) continue;
    if (first == nullptr) first = best;
    who += fmt::format("{} {} in {} ({})", who.empty() ? "" : ",", escape(best->estimator), quantity.symbol,
                       with_unit(best->groups.front().statistics.rms, quantity.key));
  }
  if (who.empty()) return {};
  if (summary.runs < summary.planned) {
    text += fmt::format("{} of {} runs are done; what follows is of these. ", summary.runs, summary.planned);
  }
  if (summary.failed > 0) text += fmt::format("{} runs failed and are not in it. ", summary.failed);
  text += "The least rms error over all runs is that of" + who + ".";
  text += changes_of(summary, *first) + intervals(summary);
  return "<h2 id=\"meaning\">What this means</h2>\n<p>" + text + "</p>\n";
}

}  // namespace glidelab::report
