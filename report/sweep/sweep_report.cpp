#include "report/sweep/sweep_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/number_text.h"
#include "report/html/html.h"
#include "report/sweep/mass_study_report.h"
#include "report/sweep/sweep_advice.h"
#include "report/sweep/sweep_meaning.h"
#include "report/sweep/sweep_plots.h"
#include "report/text/json_numbers.h"
#include "report/text/quantity_names.h"
#include "report/text/text_table.h"

namespace glidelab::report {
namespace {

using validate::ErrorStatistics;
using validate::SweepSummary;

std::vector<std::string> cells_of(const ErrorStatistics& of) {
  return {fmt::format("{} / {}", of.answered, of.runs),
          of.answered == 0 ? "–" : base::value_and_sd_text(of.bias, of.bias_sd),
          of.answered == 0 ? "–" : base::digits_text(of.rms, 3),
          of.answered == 0 ? "–" : base::digits_text(of.sd, 3),
          of.least_sd ? base::digits_text(*of.least_sd, 3) : "–",
          of.answered == 0 ? "–" : fmt::format("{:.1f} %", 100.0 * of.coverage)};
}

/// Quantity, estimator and numbers, as text: the quantities in the order in which every page has them, which is not
/// that of the database.
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

const std::vector<std::string> kHeader = {"quantity",  "estimator", "answers",  "mean error",
                                          "rms error", "stated sd", "least sd", "coverage"};

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
  bool compared = false;  // with the best possible bandwidth, where the sweep names it
  for (const validate::AccelerationError& of : summary.accelerations) compared = compared || of.regret;
  std::vector<std::string> header = {"estimator", "clips", "rms error of a(t), median (m/s²)"};
  if (compared) {
    header.insert(header.end(), {"times that of the best possible bandwidth, median", "times that, in 90 % at most"});
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
         "<p class=\"soft\">Error of each clip's a(t) against the truth, over the points that count. " +
         (compared ? "The best possible bandwidth knows the truth.</p>\n"
                   : "A sweep with the rule best-possible also shows the best possible bandwidth.</p>\n");
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
  return object;
}

/// Where some runs have no answer: the same over those that are alike at every value.
void put_alike(Json& object, const validate::Series& series, const validate::GroupStatistics& group) {
  const validate::Likeness& of = series.likeness;
  if (of.whole) return;
  object["combinations"] = of.combinations;
  object["combinations_alike"] = of.alike;
  object["alike"] = group.alike ? statistics_json(*group.alike) : Json(nullptr);
}

}  // namespace

Page sweep_report(const SweepSummary& summary, const base::Progress& progress) {
  Html body = fmt::format(
      "<h1>{}</h1>\n<p class=\"soft\">Sweep by Glidelab. Errors are recovered minus true "
      "values, over all configurations of the scenario.</p>\n",
      escape(summary.name));
  body += fmt::format(
      "<div class=\"tiles\"><div class=\"tile\"><b>{} / {}</b><span>runs</span></div><div class=\"tile\"><b{}>{}</b>"
      "<span>failed</span></div><div class=\"tile\"><b>{} s</b><span>run time, summed over the "
      "threads</span></div></div>\n",
      summary.runs, summary.planned, summary.failed > 0 ? " class=\"bad\"" : "", summary.failed,
      base::number_text(summary.cpu_s, 3));
  for (const std::string& failure : summary.failures)
    body += fmt::format("<p class=\"note\">{}</p>\n", escape(failure));
  body += sweep_meaning(summary) + mass_study_section(summary.masses);
  body += "<h2>All runs</h2>\n" + overall_table(summary);
  body +=
      "<p class=\"soft\">Stated sd and least sd (the Cramér-Rao bound, where the noise is known) are root mean squares "
      "over "
      "the "
      "runs; coverage is the fraction of the stated 95 % intervals that hold the truth.</p>\n";
  body += sweep_advice(summary) + configuration_table(summary);
  body += acceleration_table(summary);
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
  return page(summary.name, body);
}

std::string sweep_text(const SweepSummary& summary) {
  std::vector<std::vector<std::string>> rows = rows_of(summary.overall);
  rows.insert(rows.begin(), kHeader);
  std::string text = text_table(rows, 2);
  text += fmt::format("{} of {} runs, {} failed\n", summary.runs, summary.planned, summary.failed);
  for (const std::string& failure : summary.failures) text += fmt::format("  {}\n", failure);
  return text;
}

std::string sweep_json(const SweepSummary& summary) {
  Json document;
  document["format"] = 1;
  document["name"] = summary.name;
  document["runs"] = summary.runs;
  document["planned"] = summary.planned;
  document["failed"] = summary.failed;
  document["failures"] = summary.failures;
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
