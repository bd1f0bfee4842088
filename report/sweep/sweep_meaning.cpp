#include "report/sweep/sweep_meaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "base/text/number_text.h"
#include "fit/estimators.h"
#include "report/html/html.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

using validate::GroupStatistics;
using validate::Series;
using validate::SweepSummary;

/// The lines with the default rule.
std::string default_lines() {
  return std::string(fit::default_estimator().name);
}

/// Lines by a rule that uses only the data: no fixed bandwidth, no truth.
bool is_rule(const std::string& estimator) {
  const std::string lines = default_lines();
  const std::string best = validate::Analysis{lines, std::nullopt, validate::kBestPossible}.name();
  return (estimator == lines || estimator.starts_with(lines + " ")) && estimator.find(" h=") == std::string::npos &&
         estimator != best;
}

const Series* series_of(const std::vector<Series>& all, std::string_view quantity, std::string_view estimator) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Series& series) {
    return series.quantity == quantity && series.estimator == estimator;
  });
  return found == all.end() ? nullptr : &*found;
}

const GroupStatistics* group_at(const Series& series, double position) {
  const auto found = std::find_if(series.groups.begin(), series.groups.end(),
                                  [&](const GroupStatistics& group) { return group.position == position; });
  return found == series.groups.end() ? nullptr : &*found;
}

/// The factor by which an rms error must be larger: kClearlyBetterFactor, plus two standard errors of a ratio of two
/// (normal errors).
double clearly(const validate::ErrorStatistics& of) {
  return kClearlyBetterFactor * (1.0 + 2.0 / std::sqrt(static_cast<double>(of.answered)));
}

struct Winner {
  std::string estimator;
  double rms = 0.0;
};

/// The rule with the smallest error in the group at this position, of those that answer there.
std::optional<Winner> winner(const std::vector<Series>& all, std::string_view quantity, double position) {
  std::uint64_t most = 0;
  const auto each_rule = [&](const auto& visit) {
    for (const Series& series : all) {
      if (series.quantity != quantity || !is_rule(series.estimator)) continue;
      const GroupStatistics* const group = group_at(series, position);
      if (group != nullptr && group->statistics.answered > 0) visit(series, group->statistics);
    }
  };
  each_rule([&](const Series&, const validate::ErrorStatistics& of) { most = std::max(most, of.answered); });
  std::optional<Winner> best;
  each_rule([&](const Series& series, const validate::ErrorStatistics& of) {
    if (static_cast<double>(of.answered) < kLeastAnsweredShare * static_cast<double>(most)) return;
    if (!best || of.rms < best->rms) best = Winner{series.estimator, of.rms};
  });
  return best;
}

std::optional<double> overall_rms(const SweepSummary& summary, std::string_view quantity,
                                  const std::string& estimator) {
  const Series* const series = series_of(summary.overall, quantity, estimator);
  if (series == nullptr || series->groups.front().statistics.answered == 0) return std::nullopt;
  return series->groups.front().statistics.rms;
}

std::string factor_sentence(const SweepSummary& summary, const std::string& other, const std::string& words) {
  std::string factors;
  for (const QuantityName& quantity : kQuantities) {
    const auto ours = overall_rms(summary, quantity.key, default_lines()),
               theirs = overall_rms(summary, quantity.key, other);
    if (!ours || !theirs || !(*theirs > 0.0)) continue;
    factors +=
        fmt::format("{}{} in {}", factors.empty() ? "" : ", ", base::number_text(*ours / *theirs, 3), quantity.symbol);
  }
  return factors.empty() ? std::string() : fmt::format(" Its rms error divided by that of {}: {}.", words, factors);
}

/// Neighbouring groups of one axis in which a rule other than the default is clearly better.
std::string exceptions(const validate::AxisSummary& axis, const QuantityName& quantity) {
  const Series* const ours = series_of(axis.series, quantity.key, default_lines());
  if (ours == nullptr) return {};
  std::string text;
  for (std::size_t i = 0; i < ours->groups.size();) {
    const auto clear_winner = [&](std::size_t at) -> std::optional<Winner> {
      const GroupStatistics& group = ours->groups[at];
      const std::optional<Winner> best = winner(axis.series, quantity.key, group.position);
      const bool clear =
          best && best->estimator != default_lines() &&
          (group.statistics.answered == 0 || group.statistics.rms > clearly(group.statistics) * best->rms);
      return clear ? best : std::nullopt;
    };
    const std::optional<Winner> first = clear_winner(i);
    std::size_t last = i;
    while (first && last + 1 < ours->groups.size()) {
      const std::optional<Winner> next = clear_winner(last + 1);
      if (!next || next->estimator != first->estimator) break;
      ++last;
    }
    constexpr std::size_t kFewGroups = 4;  // with more, a single one is more likely due to chance
    if (first && (last > i || ours->groups.size() <= kFewGroups)) {
      text += fmt::format("{}{} in {} at {} = {}", text.empty() ? "" : ", ", escape(first->estimator), quantity.symbol,
                          escape(axis.name), ours->groups[i].label);
      if (last > i) text += fmt::format(" to {}", ours->groups[last].label);
    }
    i = last + 1;
  }
  return text;
}

}  // namespace

std::string sweep_advice(const SweepSummary& summary) {
  const auto rules = std::count_if(summary.overall.begin(), summary.overall.end(), [](const Series& series) {
    return series.quantity == "k_over_m_1_s" && is_rule(series.estimator);
  });
  if (rules < 2 || !overall_rms(summary, "k_over_m_1_s", default_lines())) return {};
  std::string text = "<h2>Which rule</h2>\n<p>Over all runs, the smallest rms error among the rules is that of";
  bool any = false;
  for (const QuantityName& quantity : kQuantities) {
    const Series* const series = series_of(summary.overall, quantity.key, default_lines());
    if (series == nullptr) continue;
    const std::optional<Winner> best = winner(summary.overall, quantity.key, series->groups.front().position);
    if (!best) continue;
    text += fmt::format("{} {} in {} ({})", any ? "," : "", escape(best->estimator), quantity.symbol,
                        base::number_text(best->rms, 3));
    any = true;
  }
  text += fmt::format("; \"{}\" is the default.", default_lines());
  const std::string best_possible = validate::Analysis{default_lines(), std::nullopt, validate::kBestPossible}.name();
  text += factor_sentence(summary, best_possible, "the best possible bandwidth");
  for (const fit::Estimator& other : fit::judged_estimators()) {
    if (!other.of_lines) text += factor_sentence(summary, std::string(other.name), fmt::format("the {}", other.title));
  }
  for (const validate::AccelerationError& of : summary.accelerations) {
    if (of.estimator != default_lines() || !of.regret || !of.regret90) continue;
    text += fmt::format(
        " Its a(t) has {} times the best possible error in the median clip, at most {} times in nine of ten.",
        base::number_text(*of.regret, 3), base::number_text(*of.regret90, 3));
  }
  std::string elsewhere;
  for (const validate::AxisSummary& axis : summary.axes) {
    if (axis.words) continue;
    for (const QuantityName& quantity : kQuantities) {
      const std::string found = exceptions(axis, quantity);
      if (!found.empty()) elsewhere += (elsewhere.empty() ? "" : "; ") + found;
    }
  }
  text += elsewhere.empty() ? fmt::format(" No rule beats it by more than {:.0f} % anywhere along an axis.",
                                          100.0 * (kClearlyBetterFactor - 1.0))
                            : fmt::format(" Rules that beat it by more than {:.0f} %: {}.",
                                          100.0 * (kClearlyBetterFactor - 1.0), elsewhere);
  return text + "</p>\n";
}

namespace {

using validate::ErrorStatistics;
using validate::GroupStatistics;
using validate::Series;
using validate::SweepSummary;

bool knows_truth(const std::string& estimator) {
  return estimator.ends_with(validate::kBestPossible);
}

/// "h=0.04 s" for the lines with that bandwidth; empty for all others.
std::string given_bandwidth(const std::string& estimator) {
  const std::string lines = std::string(fit::default_estimator().name) + " h=";
  return estimator.starts_with(lines) ? estimator.substr(lines.size() - 2) : std::string();
}

/// The series with the smallest rms error (one group each) among those that answer and are requested.
const Series* best_of(const std::vector<Series>& all, std::string_view quantity,
                      const std::function<bool(const std::string& estimator)>& asked) {
  std::uint64_t most = 0;
  for (const Series& series : all) {
    if (series.quantity == quantity) most = std::max(most, series.groups.front().statistics.answered);
  }
  const Series* best = nullptr;
  for (const Series& series : all) {
    const ErrorStatistics& of = series.groups.front().statistics;
    if (series.quantity != quantity || !asked(series.estimator) || of.answered == 0) continue;
    if (static_cast<double>(of.answered) < kLeastAnsweredShare * static_cast<double>(most)) continue;
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

/// "0.0021 1/s".
std::string error_of(double value, std::string_view quantity) {
  return base::number_text(value, 2) + unit_suffix(unit_of(quantity));
}

/// "trajectory in K/m (0.001 1/s), µ (0.0001)", for each quantity the best of those requested; `name` makes its name.
std::string winners_of(const SweepSummary& summary, const std::function<bool(const std::string& estimator)>& asked,
                       const std::function<std::string(const std::string& estimator)>& name) {
  std::string text, previous;
  for (const QuantityName& quantity : kQuantities) {
    const Series* const best = best_of(summary.overall, quantity.key, asked);
    if (best == nullptr) continue;
    const std::string who = best->estimator == previous ? "" : escape(name(best->estimator)) + " in ";
    text += fmt::format("{}{}{} ({})",
                        text.empty()  ? ""
                        : who.empty() ? ", "
                                      : "; ",
                        who, quantity.symbol, error_of(best->groups.front().statistics.rms, quantity.key));
    previous = best->estimator;
  }
  return text;
}

/// Which of several given bandwidths has the smallest error; empty if there are fewer than two.
std::string bandwidths_of(const SweepSummary& summary) {
  std::set<std::string> given;
  std::uint64_t answered = 0;
  for (const Series& series : summary.overall) {
    if (given_bandwidth(series.estimator).empty()) continue;
    given.insert(series.estimator);
    answered = std::max(answered, series.groups.front().statistics.answered);
  }
  if (given.size() < 2 || answered == 0) return {};
  const std::string winners = winners_of(
      summary, [](const std::string& estimator) { return !given_bandwidth(estimator).empty(); }, given_bandwidth);
  // Two standard errors of the ratio of two rms errors, for normal errors.
  return fmt::format(
      "<p>Of the {} given bandwidths of the lines, the smallest rms error is that of {}. Two whose errors differ by "
      "less than {:.0f} % may be equivalent.</p>\n",
      given.size(), winners, 200.0 / std::sqrt(static_cast<double>(answered)));
}

std::string at_text(const validate::AxisSummary& axis, const GroupStatistics& group) {
  if (axis.words) return escape(group.label);
  return fmt::format("{}{}{}", base::number_text(group.position, 4), axis.unit.empty() ? "" : " ", escape(axis.unit));
}

/// ", over 4 of 6 combinations of the other keys": if not all have a result.
std::string part_of(const validate::Likeness& of, std::string_view what) {
  if (of.whole || of.alike == of.combinations) return {};
  return fmt::format(", over those {} of {} {}", of.alike, of.combinations, what);
}

/// "0.001 1/s at 500 Hz and 0.004 1/s at 31.25 Hz, 4 times as much"; empty if one value has answers or none errs.
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
  return fmt::format("{} at {} and {} at {}, {} times as much{}", error_of(rms(*least), series.quantity),
                     at_text(axis, *least), error_of(rms(*most), series.quantity), at_text(axis, *most),
                     base::number_text(rms(*most) / rms(*least), 2),
                     part_of(series.likeness, "combinations of the other keys that have a result at each value"));
}

bool answered_at_two(const Series& series) {
  return std::count_if(series.groups.begin(), series.groups.end(),
                       [](const GroupStatistics& group) { return group.statistics.answered > 0; }) > 1;
}

/// "turning: 0.0001; straight: 0.0002": if each run has both, otherwise over those that have.
std::string configurations_of(const SweepSummary& summary, const Series& best) {
  std::string text, part;
  for (const validate::ConfigurationSummary& of : summary.configurations) {
    const Series* const series = series_of(of.overall, best);
    if (series == nullptr) continue;
    const ErrorStatistics* const errors = validate::comparable(*series, series->groups.front());
    if (errors == nullptr || errors->answered == 0) continue;
    part = part_of(series->likeness, "runs in which each configuration has a result");
    text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", escape(of.name), error_of(errors->rms, best.quantity));
  }
  return text + part;
}

std::string item(const std::string& text) {
  return "<li>" + text + "</li>\n";
}

/// The changes of one quantity over the keys and the configurations: a list.
std::string changes_of(const SweepSummary& summary, const Series& best) {
  std::string list, unlike;
  bool drawn = false;
  for (const validate::AxisSummary& axis : summary.axes) {
    const Series* const series = series_of(axis.series, best);
    if (series == nullptr) continue;
    const std::string span = span_of(axis, *series);
    if (!span.empty()) list += item(fmt::format("along {}: {}", escape(axis.name), span));
    const validate::Likeness& of = series->likeness;
    if (of.whole || of.alike > 0 || !answered_at_two(*series)) continue;
    unlike += (unlike.empty() ? "" : ", ") + escape(axis.name);
    drawn = of.combinations == 0;
  }
  const std::string configurations = configurations_of(summary, best);
  if (!configurations.empty()) list += item(configurations);
  if (!unlike.empty()) {
    list +=
        item(fmt::format("not compared along {}: some runs have no result, and {}", unlike,
                         drawn ? "with random values, the runs that have one cannot be compared between values of a key"
                               : "no combination of the other keys has a result at every value"));
  }
  if (list.empty()) return {};
  return fmt::format("<p>The rms error of {} with {} is:</p>\n<ul>\n{}</ul>\n", symbol_of(best.quantity),
                     escape(best.estimator), list);
}

/// The deviation of a series as a number: "80" in "80 %".
struct Listed {
  const Series* series = nullptr;
  double number = 0.0;
};

/// "K/m, µ with trajectory (80 to 88 %)": for each estimator its quantities; if there are many estimators, only the
/// first.
std::string series_text(std::vector<Listed> all, int digits, const char* unit) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Listed& x, const Listed& y) { return x.series->estimator < y.series->estimator; });
  std::string text;
  constexpr std::size_t kMost = 4;  // estimators that a paragraph can name
  std::size_t estimators = 0;
  for (std::size_t i = 0; i < all.size();) {
    std::string quantities;
    double least = all[i].number, most = least;
    const std::string& estimator = all[i].series->estimator;
    for (; i < all.size() && all[i].series->estimator == estimator; ++i) {
      quantities += (quantities.empty() ? "" : ", ") + escape(symbol_of(all[i].series->quantity));
      least = std::min(least, all[i].number);
      most = std::max(most, all[i].number);
    }
    if (++estimators > kMost) continue;
    const std::string from = base::number_text(least, digits), to = base::number_text(most, digits);
    text += fmt::format("{}{} with {} ({}{})", text.empty() ? "" : "; ", quantities, escape(estimator),
                        from == to ? from : fmt::format("{} to {}", from, to), unit);
  }
  if (estimators > kMost) text += fmt::format("; and {} more in the table", estimators - kMost);
  return text;
}

/// Two lists in one sentence each: too small and too large.
std::string two_lists(const std::string& what, const std::string& little, const std::string& much,
                      const char* little_is, const char* much_is) {
  std::string text;
  if (!little.empty()) text += fmt::format(" {} {}: {}.", what, little_is, little);
  if (!much.empty()) text += fmt::format("{} {}: {}.", little.empty() ? " " + what : " And", much_is, much);
  return text;
}

/// Intervals that contain the truth in a fraction of the runs other than 95 %.
std::string intervals(const SweepSummary& summary) {
  std::vector<Listed> narrow, wide;
  for (const Series& series : summary.overall) {
    const ErrorStatistics& of = series.groups.front().statistics;
    if (of.answered == 0 || !(of.sd > 0.0)) continue;
    const double se = std::sqrt(0.95 * 0.05 / static_cast<double>(of.answered));
    if (std::abs(of.coverage - 0.95) > 3.0 * se) {
      (of.coverage < 0.95 ? narrow : wide).push_back({&series, 100.0 * of.coverage});
    }
  }
  if (narrow.empty() && wide.empty()) {
    return " All stated 95 % intervals contain the true value as often as stated, within three standard errors.";
  }
  return two_lists("95 % intervals that contain the true value", series_text(narrow, 2, " %"),
                   series_text(wide, 2, " %"), "less often", "more often");
}

/// Stated standard deviations that are far from the errors: a few values that are far off do not show in coverage.
std::string stated_sds(const SweepSummary& summary) {
  std::vector<Listed> small, large;
  for (const Series& series : summary.overall) {
    const ErrorStatistics& of = series.groups.front().statistics;
    if (of.answered == 0 || !(of.sd > 0.0) || !(of.rms > 0.0)) continue;
    // Two standard errors of the ratio, for normal errors.
    const double clearly = kMostScatterOverStated * (1.0 + 2.0 / std::sqrt(2.0 * static_cast<double>(of.answered)));
    if (of.rms > clearly * of.sd) small.push_back({&series, of.rms / of.sd});
    if (of.sd > clearly * of.rms) large.push_back({&series, of.sd / of.rms});
  }
  return two_lists(fmt::format("Stated standard deviations that are more than {} times",
                               base::number_text(kMostScatterOverStated, 1)),
                   series_text(small, 2, " times"), series_text(large, 2, " times"), "smaller than the rms error",
                   "larger than the rms error");
}

}  // namespace

std::string sweep_meaning(const SweepSummary& summary) {
  const auto honest = [](const std::string& estimator) { return !knows_truth(estimator); };
  const Series* first = nullptr;
  for (const QuantityName& quantity : kQuantities) {
    if (first == nullptr) first = best_of(summary.overall, quantity.key, honest);
  }
  if (first == nullptr) return {};
  std::string text;
  if (summary.runs < summary.planned) {
    text += fmt::format("{} of {} runs are done; the following covers only these. ", summary.runs, summary.planned);
  }
  if (summary.failed > 0) text += fmt::format("{} runs failed and are not included. ", summary.failed);
  text += "The smallest rms error over all runs is that of " +
          winners_of(summary, honest, [](const std::string& estimator) { return estimator; }) + ".";
  const std::string sds = stated_sds(summary);
  return meaning_section("<p>" + text + "</p>\n" + bandwidths_of(summary) + changes_of(summary, *first) + "<p>" +
                         intervals(summary).substr(1) + "</p>\n" +
                         (sds.empty() ? std::string() : "<p>" + sds.substr(1) + "</p>\n"));
}

}  // namespace glidelab::report
