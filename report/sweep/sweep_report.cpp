#include "report/sweep/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text/number_text.h"
#include "report/html/html.h"
#include "report/sweep/bandwidth_study.h"
#include "report/sweep/sweep_meaning.h"
#include "report/sweep/sweep_plots.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"
#include "report/text/outside_text.h"

namespace glidelab::report {
namespace {

using base::r2_text;
using validate::FallAnswer;
using validate::MassRow;

std::string fall_text(double fall, double se) {
  return se > 0.0 ? base::value_and_sd_text(fall, se) : base::digits_text(fall, 2);
}

/// Two values, both with the larger number of decimals.
std::pair<std::string, std::string> with_equal_decimals(double one, double other) {
  const auto decimals = [](double value) {
    const std::string text = base::number_text(value, 4);
    return text.size() - std::min(text.find('.'), text.size() - 1) - 1;
  };
  const std::size_t most = std::max(decimals(one), decimals(other));
  return {fmt::format("{:.{}f}", one, most), fmt::format("{:.{}f}", other, most)};
}

std::string answer_text(const FallAnswer& answer) {
  const double published = answer.published.mu_lightest - answer.published.mu_heaviest;
  const MassRow& widest = answer.widest;
  const auto [from, to] = with_equal_decimals(answer.published.mu_lightest, answer.published.mu_heaviest);
  std::string text =
      fmt::format("<p><b>{}{}:</b> In {}, µ falls from {} to {}, by {}. ", escape(answer.published.configuration),
                  answer.others.empty() ? "" : ", " + escape(answer.others), escape(answer.published.source), from, to,
                  base::digits_text(published, 2));
  if (answer.whole) {
    text += fmt::format("Smoothing alone produces all of it at h = {} s, where the lines have R² = {}. ",
                        base::number_text(answer.whole->bandwidth_s, 2), base::r2_text(answer.whole->r2));
  } else {
    text += fmt::format("No bandwidth in this sweep produces that: h = {} s gives {}, with R² = {}. ",
                        base::number_text(widest.bandwidth_s, 2), fall_text(widest.fall(), widest.fall_se()),
                        base::r2_text(widest.r2()));
  }
  if (answer.at_r2) {
    text += fmt::format("At the published R² of {} smoothing can produce {}, {:.0f} % of the fall, with h = {} s.",
                        base::r2_text(answer.published.r2), fall_text(answer.at_r2->fall, answer.at_r2->fall_se),
                        100.0 * answer.at_r2->fall / published, base::number_text(answer.at_r2->bandwidth_s, 2));
  } else {
    text +=
        fmt::format("No bandwidth in this sweep has the published R² of {}: {}.", base::r2_text(answer.published.r2),
                    widest.r2() < answer.published.r2 ? "all of these lines are less straight" : "all are straighter");
  }
  return text + "</p>\n";
}

}  // namespace

std::string mass_study_section(const validate::MassStudy& study) {
  if (study.rows.empty()) return {};
  std::string html = "<h2 id=\"masses\">Does µ fall with mass, or does smoothing produce the fall?</h2>\n";
  for (const FallAnswer& answer : study.answers) html += answer_text(answer);
  std::vector<std::string> header = {"bandwidth h (s)"};
  for (const validate::MassPoint& point : study.rows.front().masses) {
    header.push_back(fmt::format("µ of {} kg", base::number_text(point.mass_kg, 4)));
  }
  header.insert(header.end(), {"fall of µ", "lowest R²"});
  HtmlTable table(header, 1);
  std::string before;
  for (const MassRow& row : study.rows) {
    if (row.masses.size() + 3 != header.size()) continue;  // a mass without an answer at this bandwidth
    const std::string of = fmt::format("{}{}: true µ {} for every mass", row.configuration,
                                       row.others.empty() ? "" : ", " + row.others, base::number_text(row.truth, 4));
    if (of != before) table.heading(escape(of));
    before = of;
    std::vector<std::string> cells = {base::number_text(row.bandwidth_s, 4)};
    for (const validate::MassPoint& point : row.masses) {
      cells.push_back(point.se > 0.0 ? base::value_and_sd_text(point.mu, point.se) : base::digits_text(point.mu, 4));
    }
    cells.insert(cells.end(), {fall_text(row.fall(), row.fall_se()), base::r2_text(row.r2())});
    table.row(cells);
  }
  return html + table.str() +
         "<p class=\"soft\">Lines through every smoothed point, kernels over ends and reversals included. The fall is "
         "µ of the lightest glider minus that of the heaviest; ± is one standard error over the runs, and missing "
         "where the positions are exact, because then nothing is random. R² is the lowest of a run's lines, averaged "
         "over the runs. Between two bandwidths that were run, the fall and the logarithm of 1 − R² are interpolated "
         "linearly.</p>\n";
}

namespace {

using validate::ErrorStatistics;
using validate::SweepSummary;

std::vector<std::string> cells_of(const ErrorStatistics& of) {
  const auto& sds = of.in_stated_sds;
  return {fmt::format("{} / {}", of.answered, of.runs),
          of.answered == 0 ? "–" : base::value_and_sd_text(of.bias, of.bias_sd),
          of.answered == 0 ? "–" : base::digits_text(of.rms, 3),
          of.answered == 0 ? "–" : base::digits_text(of.sd, 3),
          of.least_sd ? base::digits_text(*of.least_sd, 3) : "–",
          of.answered == 0 ? "–" : fmt::format("{:.1f} %", 100.0 * of.coverage),
          sds ? fmt::format("{:.2f} ± {:.2f}", sds->mean, sds->mean_sd) : "–",
          sds ? fmt::format("{:.2f} ± {:.2f}", sds->rms, sds->rms_sd) : "–"};
}

/// Quantity, estimator and numbers, as text: the quantities in the order used on every page, which is not that of the
/// database.
std::vector<std::vector<std::string>> rows_of(std::vector<validate::Series> overall) {
  std::ranges::stable_sort(overall, {}, [](const validate::Series& series) { return place_of(series.quantity); });
  std::vector<std::vector<std::string>> rows;
  for (const validate::Series& series : overall) {
    rows.push_back({heading_of(series.quantity), series.estimator});
    for (std::string& cell : cells_of(series.groups.front().statistics)) rows.back().push_back(std::move(cell));
  }
  return rows;
}

void add_rows(HtmlTable& table, const std::vector<validate::Series>& overall) {
  for (std::vector<std::string>& row : rows_of(overall)) {
    for (std::string& cell : row) cell = escape(cell);
    table.row(row);
  }
}

const std::vector<std::string> kHeader = {"quantity",  "estimator", "results",  "mean error",       "rms error",
                                          "stated sd", "least sd",  "coverage", "mean error in sd", "rms error in sd"};

/// The errors alone; the folded table has all else.
std::string error_table(const SweepSummary& summary) {
  HtmlTable table({"quantity", "estimator", "rms error", "stated sd", "coverage"}, 2);
  table.stack_when_narrow(1);
  for (const std::vector<std::string>& row : rows_of(summary.overall)) {
    table.row({escape(row[0]), escape(row[1]), escape(row[4]), escape(row[5]), escape(row[7])});
  }
  return table.str();
}

std::string overall_table(const SweepSummary& summary) {
  HtmlTable table(kHeader, 2);
  add_rows(table, summary.overall);
  return table.str();
}

std::string configuration_table(const SweepSummary& summary) {
  if (summary.configurations.empty()) return {};
  HtmlTable table(kHeader, 2);
  for (const validate::ConfigurationSummary& of : summary.configurations) {
    table.heading(escape(of.name));
    add_rows(table, of.overall);
  }
  return "<h2 id=\"configurations\">Each configuration</h2>\n" + table.str();
}

std::string acceleration_table(const SweepSummary& summary) {
  if (summary.accelerations.empty()) return {};
  bool compared = false;  // with the best possible bandwidth, if the sweep names it
  for (const validate::AccelerationError& of : summary.accelerations) compared = compared || of.regret;
  std::vector<std::string> header = {"estimator", "clips", "rms error of a(t), median (m/s²)"};
  if (compared) {
    header.insert(header.end(), {"ratio to the best possible bandwidth, median", "ratio, 90th percentile"});
  }
  HtmlTable table(header, 1);
  const auto ratio = [](const std::optional<double>& value) { return value ? base::digits_text(*value, 3) : "–"; };
  const auto add = [&](const std::vector<validate::AccelerationError>& all) {
    for (const validate::AccelerationError& of : all) {
      std::vector<std::string> row = {escape(of.estimator), fmt::format("{}", of.clips),
                                      base::digits_text(of.median_m_s2, 3)};
      if (compared) row.insert(row.end(), {ratio(of.regret), ratio(of.regret90)});
      table.row(row);
    }
  };
  add(summary.accelerations);
  for (const validate::ConfigurationSummary& of : summary.configurations) {
    if (of.accelerations.empty()) continue;
    table.heading(escape(of.name));
    add(of.accelerations);
  }
  return "<h2>Accelerations</h2>\n" + table.str() +
         "<p class=\"soft\">Error of each clip's a(t) against the truth, over the points that are used. " +
         (compared ? "The best possible bandwidth knows the truth.</p>\n"
                   : "Add the rule best-possible to the sweep to compare with the best possible bandwidth.</p>\n");
}

Json statistics_json(const ErrorStatistics& of) {
  Json object;
  object["runs"] = of.runs;
  object["answered"] = of.answered;
  if (of.answered == 0) return object;
  put(object, "mean_error", of.bias);
  put(object, "mean_error_sd", of.bias_sd);
  put(object, "rms_error", of.rms);
  put(object, "stated_sd", of.sd);
  put(object, "least_sd", of.least_sd, "known for tracks only, whose noise is known");
  put(object, "coverage", of.coverage);
  const char* why = "no standard deviation is stated";
  const auto in_sds = [&](const char* key, double ErrorStatistics::InStatedSds::*member) {
    put(object, key, of.in_stated_sds ? std::optional((*of.in_stated_sds).*member) : std::nullopt, why);
  };
  in_sds("mean_error_in_stated_sd", &ErrorStatistics::InStatedSds::mean);
  in_sds("mean_error_in_stated_sd_sd", &ErrorStatistics::InStatedSds::mean_sd);
  in_sds("rms_error_in_stated_sd", &ErrorStatistics::InStatedSds::rms);
  in_sds("rms_error_in_stated_sd_sd", &ErrorStatistics::InStatedSds::rms_sd);
  return object;
}

/// If some runs have no answer: the same over those that are comparable at every value.
void put_alike(Json& object, const validate::Series& series, const validate::GroupStatistics& group) {
  const validate::Likeness& of = series.likeness;
  if (of.whole) return;
  object["combinations"] = of.combinations;
  object["combinations_alike"] = of.alike;
  object["alike"] = group.alike ? statistics_json(*group.alike) : Json(nullptr);
}

Html tables_of(const SweepSummary& summary) {
  Html body = "<h2>All runs</h2>\n" + overall_table(summary);
  body +=
      "<p class=\"soft\">Stated sd and least sd (the Cramér-Rao bound, where the noise is known) are root mean squares "
      "over the runs; coverage is the fraction of the stated 95 % intervals that contain the true value.</p>\n";
  body += sweep_advice(summary) + configuration_table(summary);
  body += acceleration_table(summary);
  return body;
}

Html axis_plots(const SweepSummary& summary, const base::Progress& progress) {
  Html body;
  double done = 0.0;
  for (const validate::AxisSummary& axis : summary.axes) {
    Html drawn;
    for (const QuantityName& quantity : kQuantities) {
      progress("drawing", done++ / static_cast<double>(summary.axes.size() * kQuantities.size()));
      const std::vector<Plot> plots = sweep_plots(axis, quantity.key, summary.configurations);
      if (plots.empty()) continue;
      drawn += fmt::format("<h3>{}</h3>\n", escape(heading_of(quantity.key))) + figures(plots);
    }
    if (!drawn.plots().empty()) body += fmt::format("<h2>Over {}</h2>\n", escape(axis.name)) + drawn;
  }
  return body;
}

/// The error of the first quantity that has one over the first two keys along which it changes.
Html answer_plots(const SweepSummary& summary) {
  constexpr std::size_t kMost = 2;
  for (const QuantityName& quantity : kQuantities) {
    std::vector<Plot> shown;
    for (const validate::AxisSummary& axis : summary.axes) {
      const std::vector<Plot> plots = sweep_plots(axis, quantity.key, summary.configurations);
      if (!plots.empty() && shown.size() < kMost) shown.push_back(plots.front());
    }
    if (!shown.empty()) return figures(shown);
  }
  return {};
}

/// "6 runs with camera.frame_rate_hz = 120: …", for each kind of reason.
std::vector<std::string> failure_lines(const validate::FailedRuns& failures) {
  const auto runs = [](std::uint64_t n) { return fmt::format("{} {}", n, n == 1 ? "run" : "runs"); };
  std::vector<std::string> lines;
  for (const validate::FailedRuns::Kind& kind : failures.kinds) {
    lines.push_back(fmt::format("{}{}{}{}", runs(kind.runs), kind.one_text ? "" : ", one of them",
                                kind.of_scenario ? " with " : ": ", kind.why));
  }
  if (failures.other_kinds > 0) {
    lines.push_back(fmt::format("and {} more {} ({})", failures.other_kinds,
                                failures.other_kinds == 1 ? "kind" : "kinds", runs(failures.other_runs)));
  }
  return lines;
}

std::string runs_of(const SweepSummary& summary) {
  std::string html = fmt::format(
      "<div class=\"tiles\"><div class=\"tile\"><b>{} / {}</b><span>runs</span></div><div class=\"tile\"><b{}>{}</b>"
      "<span>{}</span></div><div class=\"tile\"><b>{} s</b><span>run time, summed over the "
      "threads</span></div></div>\n",
      summary.runs, summary.planned, summary.failed > 0 ? " class=\"bad\"" : "", summary.failed,
      summary.outside ? "not made or not analysed" : "failed", base::number_text(summary.cpu_s, 3));
  for (const std::string& failure : failure_lines(summary.failures))
    html += fmt::format("<p class=\"note\">{}</p>\n", escape(failure));
  if (summary.outside) html += fmt::format("<p>{}.</p>\n", escape(outside_text(*summary.outside)));
  return html;
}

}  // namespace

Page sweep_report(const SweepSummary& summary, const base::Progress& progress) {
  const std::string soft =
      "<p class=\"soft\">Errors are recovered minus true values, over all configurations of the "
      "scenario.</p>\n";
  if (const std::optional<BandwidthAnswer> answer = bandwidth_answer(summary)) {
    Html body = question_heading(summary.name, "Which bandwidth?") +
                fmt::format("<p><b>{}</b></p>\n", escape_with_code(answer->text));
    body += figures(bandwidth_plots(summary));
    body += bandwidth_table(summary) + soft + runs_of(summary);
    body += folded("In words", sweep_meaning(summary) + mass_study_section(summary.masses));
    body += folded("All runs, estimators and configurations", tables_of(summary));
    body += folded("Over each key of the sweep", axis_plots(summary, progress));
    return page(summary.name, body);
  }
  Html body = question_heading(summary.name, "How large are the errors, and what do they depend on?") + soft;
  body += sweep_meaning(summary) + answer_plots(summary) + error_table(summary) + runs_of(summary);
  body += mass_study_section(summary.masses);
  body += folded("All runs, estimators and configurations", tables_of(summary));
  body += folded("Over each key of the sweep", axis_plots(summary, progress));
  return page(summary.name, body);
}

namespace {

/// The errors of each quantity, one table a quantity; the page has all columns.
std::string errors_text(const SweepSummary& summary) {
  constexpr std::size_t kResults = 2;
  const std::vector<std::size_t> shown = {1, 3, 4, 5, 7};  // columns of kHeader
  std::vector<std::vector<std::string>> all = rows_of(summary.overall);
  const bool complete = std::ranges::all_of(summary.overall, [](const validate::Series& series) {
    const ErrorStatistics& of = series.groups.front().statistics;
    return of.answered == of.runs;
  });
  std::string text;
  for (std::size_t i = 0; i < all.size();) {
    std::vector<std::vector<std::string>> rows;
    const auto add = [&](const std::vector<std::string>& from) {
      std::vector<std::string>& row = rows.emplace_back();
      for (const std::size_t column : shown) row.push_back(from[column]);
      if (!complete) row.push_back(from[kResults]);
    };
    add(kHeader);
    const std::string quantity = all[i].front();
    for (; i < all.size() && all[i].front() == quantity; ++i) add(all[i]);
    text += fmt::format("{}:\n{}\n", quantity, text_table(rows, 1));
  }
  return text;
}

}  // namespace

std::string sweep_text(const SweepSummary& summary) {
  const std::optional<BandwidthAnswer> answer = bandwidth_answer(summary);
  std::string text =
      answer ? without_code_marks(answer->text) + "\n\n" + bandwidth_text(summary) : errors_text(summary);
  // Runs of an estimator of the user's own fail in ways of their own, which its line counts.
  text += fmt::format("{} of {} runs", summary.runs, summary.planned);
  text += summary.outside && summary.failed == 0 ? "\n" : fmt::format(", {} failed\n", summary.failed);
  for (const std::string& failure : failure_lines(summary.failures)) text += fmt::format("  {}\n", failure);
  if (summary.outside) text += outside_text(*summary.outside) + "\n";
  return text;
}

std::string sweep_json(const SweepSummary& summary) {
  Json document;
  document["format"] = 1;
  document["name"] = summary.name;
  document["runs"] = summary.runs;
  document["planned"] = summary.planned;
  document["failed"] = summary.failed;
  document["failures"] = failure_lines(summary.failures);
  if (summary.outside) document["outside"] = outside_json(*summary.outside);
  if (const std::optional<BandwidthAnswer> answer = bandwidth_answer(summary)) {
    document["bandwidth"] = {{"answer", answer->text},
                             {"use_s", answer->use_s},
                             {"nearly_as_good_from_s", answer->from_s},
                             {"nearly_as_good_to_s", answer->to_s},
                             {"too_narrow_at_s", answer->narrow_s},
                             {"too_wide_at_s", answer->wide_s},
                             {"no_line_at_s", answer->unanswered_s}};
  }
  document["overall"] = Json::array();
  for (const validate::Series& series : summary.overall) {
    Json object = statistics_json(series.groups.front().statistics);
    object["quantity"] = series.quantity;
    object["estimator"] = series.estimator;
    document["overall"].push_back(std::move(object));
  }
  document["configurations"] = Json::array();
  for (const validate::ConfigurationSummary& of : summary.configurations) {
    for (const validate::Series& series : of.overall) {
      Json object = statistics_json(series.groups.front().statistics);
      object["configuration"] = of.name;
      object["quantity"] = series.quantity;
      object["estimator"] = series.estimator;
      document["configurations"].push_back(std::move(object));
    }
  }
  document["accelerations"] = Json::array();
  std::vector<validate::AccelerationError> accelerations = summary.accelerations;
  for (const validate::ConfigurationSummary& of : summary.configurations) {
    accelerations.insert(accelerations.end(), of.accelerations.begin(), of.accelerations.end());
  }
  for (const validate::AccelerationError& of : accelerations) {
    Json object;
    if (!of.configuration.empty()) object["configuration"] = of.configuration;
    object["estimator"] = of.estimator;
    object["clips"] = of.clips;
    put(object, "median_rms_error_m_s2", of.median_m_s2);
    put(object, "regret", of.regret, "the sweep has no rule best-possible");
    put(object, "regret_90", of.regret90, "the sweep has no rule best-possible");
    document["accelerations"].push_back(std::move(object));
  }
  document["axes"] = Json::array();
  for (const validate::AxisSummary& axis : summary.axes) {
    Json of_axis;
    of_axis["name"] = axis.name;
    of_axis["groups"] = Json::array();
    for (const validate::Series& series : axis.series) {
      for (const validate::GroupStatistics& group : series.groups) {
        Json object = statistics_json(group.statistics);
        object["quantity"] = series.quantity;
        object["estimator"] = series.estimator;
        object["at"] = group.label;
        put_alike(object, series, group);
        of_axis["groups"].push_back(std::move(object));
      }
    }
    document["axes"].push_back(std::move(of_axis));
  }
  return json_text(document);
}

}  // namespace glidelab::report
