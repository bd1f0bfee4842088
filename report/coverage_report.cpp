#include "report/coverage_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "report/gnuplot.h"
#include "report/html.h"
#include "report/json_numbers.h"
#include "report/number_text.h"
#include "report/plot_style.h"
#include "report/quantity_names.h"
#include "report/text_table.h"

namespace glidelab::report {
namespace {

constexpr double kAstray = 2.0;  // scatter over stated sd; chance alone moves the ratio of 200 values by a tenth

std::string with_unit(const validate::CoverageRow& row) {
  const std::string unit(unit_of(row.quantity));
  return std::string(symbol_of(row.quantity)) + (unit.empty() ? "" : fmt::format(" ({})", unit));
}

std::string estimator_name(const std::string& estimator) {
  if (estimator == "trajectory") return "fit of the whole motion";
  if (estimator == "phase-diagram-gls") return "generalised lines";
  if (estimator == "phase-diagram") return "lines of the phase diagram";
  if (estimator == "naive-lines") return "naive lines (for contrast)";
  return estimator;
}

std::vector<std::string> cells_of(const validate::CoverageRow& row) {
  if (row.determined == 0) return {with_unit(row), value_text(row.truth, 0.0), "–", "–", "–", "–", "–", "–", "0"};
  return {with_unit(row),
          value_text(row.truth, row.sd),
          error_text(row.bias, row.sd),
          sd_text(row.sd),
          sd_text(row.stated_sd),
          row.cramer_rao_sd ? sd_text(*row.cramer_rao_sd) : "–",
          row.efficiency ? number_text(*row.efficiency, 2) : "–",
          fmt::format("{:.1f} % ({:.1f} – {:.1f})", 100.0 * row.coverage, 100.0 * row.low95, 100.0 * row.high95),
          fmt::format("{}", row.determined)};
}

/// Coverage of every row with its binomial interval, a line at 95 %.
Plot coverage_plot(const validate::Coverage& coverage) {
  std::string tics, script(kFrame);
  std::vector<PlotData> data;
  const std::vector<std::string> estimators = {"phase-diagram", "phase-diagram-gls", "trajectory", "naive-lines"};
  for (std::size_t e = 0; e < estimators.size(); ++e) data.push_back({fmt::format("e{}", e), {}});
  double row_number = 0.0, lowest = 90.0;
  for (const validate::CoverageRow& row : coverage.rows) {
    if (row.determined == 0) continue;
    row_number += 1.0;
    const auto place =
        static_cast<std::size_t>(std::find(estimators.begin(), estimators.end(), row.estimator) - estimators.begin());
    if (place == estimators.size()) continue;
    lowest = std::min(lowest, 100.0 * row.low95 - 2.0);
    data[place].rows.push_back({100.0 * row.coverage, row_number, 100.0 * row.low95, 100.0 * row.high95});
    tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ",
                        gnuplot_quoted(fmt::format("{}  {}", row.configuration, symbol_of(row.quantity))), row_number);
  }
  script += fmt::format(
      "unset offsets\nset xrange [{:.4g}:100.5]\nset yrange [{:.4g}:0.3]\nset ytics ({})\n"
      "set xlabel 'intervals of 95 % that hold the truth  (%)'\nset key outside top center horizontal maxcols 1\n"
      "set arrow from 95, graph 0 to 95, graph 1 nohead back lw 1 lc rgb '#888888'\nplot ",
      lowest, row_number + 0.7, tics);
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    if (data[e].rows.empty()) continue;
    script += fmt::format("{}${} using 1:2:3:4 with xerrorbars pt 7 ps 0.7 lw 1.5 lc rgb '{}' title {}",
                          script.ends_with("plot ") ? "" : ", ", data[e].name, color(e),
                          gnuplot_quoted(estimator_name(estimators[e])));
  }
  const int height = 190 + 18 * std::max(10, static_cast<int>(row_number));
  return {Drawing{script, data, {560, height}}, "Coverage of the stated intervals, with its own 95 % interval",
          "Coverage of each quantity by each estimator"};
}

/// "20 µm", or "12 to 20 µm".
std::string noise_text(const validate::Coverage& coverage) {
  if (coverage.noise_sd_m.empty()) return "no";
  const auto [least, most] = std::minmax_element(coverage.noise_sd_m.begin(), coverage.noise_sd_m.end());
  const std::string from = number_text(*least * 1e6, 3), to = number_text(*most * 1e6, 3);
  return from == to ? from + " µm" : fmt::format("{} to {} µm", from, to);
}

std::string list_of(const std::vector<validate::CoverageRow>& rows) {
  std::string text;
  for (const validate::CoverageRow& row : rows) {
    text += fmt::format("{}{} of {} by the {} ({:.1f} %)", text.empty() ? "" : ", ", escape(symbol_of(row.quantity)),
                        escape(row.configuration), escape(estimator_name(row.estimator)), 100.0 * row.coverage);
  }
  return text;
}

/// Rows of which single values lie so far off that all of them scatter much farther than stated. An interval may hold
/// the truth in 95 % of the replicates and still say nothing of the few that are lost.
std::vector<validate::CoverageRow> scattered(const validate::Coverage& coverage) {
  std::vector<validate::CoverageRow> rows;
  for (const validate::CoverageRow& row : coverage.rows) {
    if (row.determined > 0 && row.estimator != "naive-lines" && row.sd > kAstray * row.stated_sd) rows.push_back(row);
  }
  return rows;
}

/// "µ (3.0 times), α (3.1 times) of m1 by the generalised lines; …"
std::string astray_list(const std::vector<validate::CoverageRow>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const validate::CoverageRow& row = rows[i];
    const auto as_next = [&](std::size_t k) {
      return rows[k].configuration == row.configuration && rows[k].estimator == row.estimator;
    };
    text += fmt::format("{}{} ({:.1f} times)",
                        i == 0           ? ""
                        : as_next(i - 1) ? ", "
                                         : "; ",
                        escape(symbol_of(row.quantity)), row.sd / row.stated_sd);
    if (i + 1 == rows.size() || !as_next(i + 1)) {
      text += fmt::format(" of {} by the {}", escape(row.configuration), escape(estimator_name(row.estimator)));
    }
  }
  return text;
}

std::string meaning(const validate::Coverage& coverage) {
  const std::vector<validate::CoverageRow> narrow = validate::too_narrow(coverage), wide = validate::too_wide(coverage);
  std::string text = "<h2 id=\"meaning\">What this means</h2>\n";
  if (narrow.empty()) {
    text +=
        "<p>The intervals of every estimator but the naive one hold the truth as often as they say, as far as this "
        "many "
        "replicates can tell.</p>\n";
  } else {
    text += fmt::format("<p>These intervals hold the truth less often than they say: {}.</p>\n", list_of(narrow));
  }
  if (!wide.empty()) {
    text += fmt::format("<p>These are wider than they need be: {}.</p>\n", list_of(wide));
  }
  const std::vector<validate::CoverageRow> astray = scattered(coverage);
  if (!astray.empty()) {
    text += fmt::format(
        "<p>The values scatter more than {} times as far as stated for {}. A few replicates lie far off, too few to "
        "show in how many of 95 % intervals hold the truth: record such a motion more than once.</p>\n",
        number_text(kAstray, 2), astray_list(astray));
  }
  text +=
      "<p>The naive lines treat smoothed points as if they were independent. They are shown so that one sees what "
      "that does to an interval.</p>\n";
  return text;
}

}  // namespace

std::string coverage_json(const validate::Coverage& coverage) {
  Json document;
  document["format"] = 1;
  document["replicates"] = coverage.replicates;
  const auto [least, most] = std::minmax_element(coverage.noise_sd_m.begin(), coverage.noise_sd_m.end());
  if (coverage.noise_sd_m.empty() || *least != *most) {
    put(document, "noise_sd_m", std::nullopt, "the clips differ: noise_sd_of_clips_m");
  } else {
    put(document, "noise_sd_m", *least);
  }
  document["noise_sd_of_clips_m"] = coverage.noise_sd_m;
  document["noise_from"] = coverage.camera_noise ? "camera" : "given";
  document["quantities"] = Json::array();
  for (const validate::CoverageRow& row : coverage.rows) {
    Json object{{"configuration", row.configuration}, {"estimator", row.estimator}, {"quantity", row.quantity}};
    put(object, "truth", row.truth);
    object["determined"] = row.determined;
    object["covered"] = row.covered;
    if (row.determined > 0) {
      put(object, "bias", row.bias);
      put(object, "sd", row.sd);
      put(object, "stated_sd", row.stated_sd);
      put(object, "coverage", row.coverage);
      object["coverage_interval95"] = {row.low95, row.high95};
      put(object, "p_value", row.p_value);
    }
    put(object, "cramer_rao_sd", row.cramer_rao_sd, "the motion does not determine it, or the law is not equation (8)");
    put(object, "efficiency", row.efficiency, "no bound, or no value");
    document["quantities"].push_back(std::move(object));
  }
  return json_text(document);
}

std::string coverage_text(const validate::Coverage& coverage) {
  std::vector<std::vector<std::string>> rows = {{"configuration", "estimator", "quantity", "truth", "bias", "sd",
                                                 "stated sd", "least sd", "efficiency", "coverage (95 % interval)",
                                                 "values"}};
  std::string configuration, estimator;
  for (const validate::CoverageRow& row : coverage.rows) {
    const bool first = row.configuration != configuration, other = first || row.estimator != estimator;
    configuration = row.configuration;
    estimator = row.estimator;
    std::vector<std::string> cells = {first ? row.configuration : "", other ? row.estimator : ""};
    for (std::string& cell : cells_of(row)) cells.push_back(std::move(cell));
    rows.push_back(std::move(cells));
  }
  return text_table(rows, 3);
}

Page coverage_page(const std::string& title, const validate::Coverage& coverage) {
  Html body = fmt::format(
      "<h1>{}</h1>\n<p class=\"soft\">{} replicates of the scenario's motions as tracks, with {} of independent "
      "noise in every position{}, a clock that is off by 20 ppm (one standard deviation) and no lost frames, analysed "
      "by each estimator.</p>\n",
      escape(title), coverage.replicates, noise_text(coverage),
      coverage.camera_noise ? " (the least that the camera, the light and the marker allow)" : "");
  body += meaning(coverage);
  body += figures({coverage_plot(coverage)});
  HtmlTable table({"quantity", "truth", "bias", "sd", "stated sd", "least sd", "efficiency", "coverage", "values"});
  std::string configuration, estimator;
  for (const validate::CoverageRow& row : coverage.rows) {
    if (row.configuration != configuration || row.estimator != estimator)
      table.heading(fmt::format("{}: {}", escape(row.configuration), escape(estimator_name(row.estimator))));
    configuration = row.configuration;
    estimator = row.estimator;
    std::vector<std::string> cells = cells_of(row);
    cells[0] = escape(cells[0]);
    table.row(cells);
  }
  body += "<h2 id=\"table\">Every quantity</h2>\n" + table.str();
  body +=
      "<p class=\"soft\">bias and sd are those of the values over the replicates, stated sd what the estimator says "
      "(root mean square), least sd the Cramér-Rao bound, efficiency least sd² / (sd² + bias²), coverage the part "
      "of the intervals of 95 % that hold the truth, with its own 95 % interval (Clopper and Pearson).</p>\n";
  return page(title, body);
}

}  // namespace glidelab::report
