#include "report/sweep/sweep_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/text/number_text.h"
#include "fit/estimators.h"
#include "report/html/html.h"
#include "report/text/quantity_names.h"

namespace glidelab::report {
namespace {

using validate::GroupStatistics;
using validate::Series;
using validate::SweepSummary;

/// The lines with the default rule.
std::string default_lines() {
  return std::string(fit::default_estimator().name);
}

/// A line by a rule that knows no more than the data: no fixed bandwidth, no truth.
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

/// By what factor an rms error must be larger: kClearlyBetterFactor, and two standard errors of a ratio of two (normal
/// errors).
double clearly(const validate::ErrorStatistics& of) {
  return kClearlyBetterFactor * (1.0 + 2.0 / std::sqrt(static_cast<double>(of.answered)));
}

struct Winner {
  std::string estimator;
  double rms = 0.0;
};

/// The rule with the least error in the group at this position, of those that answer there.
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
  return factors.empty() ? std::string() : fmt::format(" Its rms error over that of {}: {}.", words, factors);
}

/// Neighbouring groups of one axis in which another rule than the default wins clearly.
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
    constexpr std::size_t kFewGroups = 4;  // of more, one alone is chance more often than not
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
  std::string text = "<h2>Which rule</h2>\n<p>Over all runs, among the rules alone, the least rms error is that of";
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
                            : fmt::format(" By more than {:.0f} % it is beaten by {}.",
                                          100.0 * (kClearlyBetterFactor - 1.0), elsewhere);
  return text + "</p>\n";
}

}  // namespace glidelab::report
