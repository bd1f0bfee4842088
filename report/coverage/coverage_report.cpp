#include "report/coverage/coverage_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <vector>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/sweep/sweep_meaning.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"
#include "report/text/outside_text.h"

namespace glidelab::report {

Plot coverage_plot(const validate::Coverage& coverage) {
  std::string tics, script(kFrame);
  std::vector<PlotData> data;
  const std::vector<std::string> estimators = validate::coverage_estimators(coverage.outside);
  for (std::size_t e = 0; e < estimators.size(); ++e) data.push_back({fmt::format("e{}", e), {}});
  double row_number = 0.0, lowest = 90.0;
  for (const validate::CoverageRow& row : coverage.rows) {
    if (row.determined == 0) continue;
    row_number += 1.0;
    const auto place = std::find(estimators.begin(), estimators.end(), row.estimator) - estimators.begin();
    lowest = std::min(lowest, 100.0 * row.low95 - 2.0);
    data.at(static_cast<std::size_t>(place))
        .rows.push_back({100.0 * row.coverage, row_number, 100.0 * row.low95, 100.0 * row.high95});
    tics += fmt::format("{}{} {}", tics.empty() ? "" : ", ",
                        gnuplot_quoted(fmt::format("{}  {}", shortened(row.configuration), symbol_of(row.quantity))),
                        row_number);
  }
  script += fmt::format(
      "unset offsets\nset xrange [{:.4g}:100.5]\nset yrange [{:.4g}:0.3]\nset ytics ({})\n"
      "set xlabel '95 % intervals that contain the true value (%)'\nset key outside top center horizontal maxcols 1\n"
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

Plot reliability_plot(const validate::Coverage& coverage) {
  // A column of the plot for each level: if plotted over the level itself, 90, 95 and 99 % would overlap.
  PlotData band{"band", {}}, stated{"stated", {}};
  std::string tics;
  const std::vector<std::string> estimators = validate::coverage_estimators(coverage.outside);
  for (std::size_t i = 0; i < coverage.levels.size(); ++i) {
    const double level = coverage.levels[i], x = static_cast<double>(i);
    const validate::CoverageBand of = validate::band_of(level, coverage.replicates);
    band.rows.push_back({x, 0.5 * (of.low + of.high) * 100.0, x - 0.4, x + 0.4, 100.0 * of.low, 100.0 * of.high});
    stated.rows.push_back({x, 100.0 * level, 0.4});
    tics += fmt::format("{}'{:g}' {}", i == 0 ? "" : ", ", 100.0 * level, i);
  }
  std::vector<PlotData> data = {band, stated};
  std::string script =
      std::string(kFrame) +
      fmt::format(
          "unset offsets\nset xrange [-0.5:{}]\nset yrange [-2:102]\nset key maxcols 2\nset xtics ({})\n"
          "set xlabel 'stated level of the intervals (%)'\n"
          "set ylabel 'intervals that contain the true value (%)'\n"
          "plot $band using 1:2:3:4:5:6 with boxxyerror fs solid noborder fc rgb '#dddddd' title 'chance (95 %)', "
          "$stated using 1:2:3 with xerrorbars pt 0 lw 1 lc rgb '#555555' title 'as stated'",
          static_cast<double>(coverage.levels.size()) - 0.5, tics);
  for (std::size_t e = 0; e < estimators.size(); ++e) {
    PlotData points{fmt::format("e{}", e), {}};
    const double beside = 0.18 * (static_cast<double>(e) - 1.5);  // so that estimators do not hide each other
    for (const validate::CoverageRow& row : coverage.rows) {
      if (row.estimator != estimators[e]) continue;
      for (std::size_t i = 0; i < row.levels.size(); ++i) {
        points.rows.push_back({static_cast<double>(i) + beside, 100.0 * row.levels[i].coverage});
      }
    }
    if (points.rows.empty()) continue;
    script += fmt::format(", ${} using 1:2 with points pt 7 ps 0.5 lc rgb '{}' title {}", points.name, color(e),
                          gnuplot_quoted(estimator_name(estimators[e])));
    data.push_back(std::move(points));
  }
  return {
      Drawing{script, data, {560, 480}},
      fmt::format("How many of the intervals of each level contain the true value: a point for each quantity, the "
                  "estimators side by side; grey: the range that chance gives 95 times in 100, with {} replicates and "
                  "intervals that are right",
                  coverage.replicates),
      "Reliability: actual against nominal coverage"};
}

namespace {

/// "95 %", "99.5 %".
std::string level_text(double level) {
  return base::number_text(100.0 * level, 4) + " %";
}

enum Cell : std::size_t { kBias = 2, kSd = 3, kStatedSd = 4, kCoverage = 7 };  // of cells_of()

std::vector<std::string> cells_of(const validate::CoverageRow& row) {
  if (row.determined == 0)
    return {heading_of(row.quantity), base::value_text(row.truth, 0.0), "–", "–", "–", "–", "–", "–", "0"};
  return {heading_of(row.quantity),
          base::value_text(row.truth, row.sd),
          base::error_text(row.bias, row.sd),
          base::sd_text(row.sd),
          base::sd_text(row.stated_sd),
          row.cramer_rao_sd ? base::sd_text(*row.cramer_rao_sd) : "–",
          row.efficiency ? base::digits_text(*row.efficiency, 2) : "–",
          fmt::format("{:.1f} % ({:.1f} – {:.1f})", 100.0 * row.coverage, 100.0 * row.low95, 100.0 * row.high95),
          fmt::format("{}", row.determined)};
}

/// Marked entries fail the test (too_narrow, too_wide).
std::string level_table(const validate::Coverage& coverage) {
  std::vector<std::string> header = {"quantity"};
  for (const double level : coverage.levels) header.push_back(level_text(level));
  HtmlTable table(header);
  table.stack_when_narrow(1);
  std::vector<validate::CoverageFailure> failures = validate::too_narrow(coverage);
  for (validate::CoverageFailure& one : validate::too_wide(coverage)) failures.push_back(std::move(one));
  std::string before;
  for (const validate::CoverageRow& row : coverage.rows) {
    const std::string of = fmt::format("{}: {}", escape(row.configuration), escape(estimator_name(row.estimator)));
    if (of != before) table.heading(of);
    before = of;
    std::vector<std::string> cells = {escape(symbol_of(row.quantity))};
    for (std::size_t i = 0; i < coverage.levels.size(); ++i) {
      if (i >= row.levels.size()) {
        cells.emplace_back("–");
        continue;
      }
      const validate::LevelCount& at = row.levels[i];
      const bool fails = std::any_of(failures.begin(), failures.end(), [&](const validate::CoverageFailure& one) {
        return one.at.level == at.level && one.row.configuration == row.configuration &&
               one.row.estimator == row.estimator && one.row.quantity == row.quantity;
      });
      cells.push_back(fmt::format("{0}{1:.1f} % (p {2}){3}", fails ? "<b class=\"bad\">" : "", 100.0 * at.coverage,
                                  at.p_value < 1e-4 ? "&lt; 0.0001" : "= " + base::digits_text(at.p_value, 2),
                                  fails ? "</b>" : ""));
    }
    table.row(cells);
  }
  return table.str() +
         "<p class=\"soft\">Fraction of the intervals of each level that contain the true value, and the probability "
         "that "
         "chance alone gives a count at least that far from the level (exact binomial test, two-sided). Marked: below "
         "1 % divided by the number of all intervals and levels except the naive ones (Bonferroni). An interval of "
         "another level than 95 % is the stated one, scaled by the quantiles of Student's t.</p>\n";
}

/// "20 µm", or "12 to 20 µm".
std::string noise_text(const validate::Coverage& coverage) {
  if (coverage.noise_sd_m.empty()) return "no";
  const auto [least, most] = std::minmax_element(coverage.noise_sd_m.begin(), coverage.noise_sd_m.end());
  const std::string from = base::digits_text(*least * 1e6, 3), to = base::digits_text(*most * 1e6, 3);
  return from == to ? base::number_text(*least * 1e6, 3) + " µm" : fmt::format("{} to {} µm", from, to);
}

/// "µ of m1 with the generalised lines: 41.0 % at 50 %, 88.0 % at 95 %": an item for each row, its levels together.
std::string failures_html(const std::vector<validate::CoverageFailure>& failures) {
  std::string text;
  for (std::size_t i = 0; i < failures.size(); ++i) {
    const validate::CoverageRow& row = failures[i].row;
    const bool again = i > 0 && failures[i - 1].row.configuration == row.configuration &&
                       failures[i - 1].row.estimator == row.estimator && failures[i - 1].row.quantity == row.quantity;
    if (!again) {
      text += fmt::format("{}<li>{} of {} {}: ", i == 0 ? "" : "</li>\n", escape(symbol_of(row.quantity)),
                          escape(row.configuration), escape(by_estimator(row.estimator)));
    }
    text += fmt::format("{}{:.1f} % at {}", again ? ", " : "", 100.0 * failures[i].at.coverage,
                        level_text(failures[i].at.level));
  }
  return "<ul>\n" + text + "</li>\n</ul>\n";
}

/// Rows in which a few values are so far off that the scatter is much larger than stated. An interval may contain the
/// truth in 95 % of the replicates and still not account for the few bad ones.
std::vector<validate::CoverageRow> scattered(const validate::Coverage& coverage) {
  std::vector<validate::CoverageRow> rows;
  for (const validate::CoverageRow& row : coverage.rows) {
    if (row.determined > 0 && row.estimator != validate::kNaiveLines && row.sd > kMostScatterOverStated * row.stated_sd)
      rows.push_back(row);
  }
  return rows;
}

/// "µ (3.0 times), α (3.1 times) of m1 with the generalised lines; …"
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
      text += fmt::format(" of {} {}", escape(row.configuration), escape(by_estimator(row.estimator)));
    }
  }
  return text;
}

/// Rows that are judged: those with a value, the naive lines apart.
std::vector<const validate::CoverageRow*> judged_rows(const validate::Coverage& coverage) {
  std::vector<const validate::CoverageRow*> rows;
  for (const validate::CoverageRow& row : coverage.rows) {
    if (row.determined > 0 && row.estimator != validate::kNaiveLines) rows.push_back(&row);
  }
  return rows;
}

/// "µ of m1 with the generalised lines": rows whose intervals hold less often than stated, at any level.
std::set<std::string> failing_rows(const validate::Coverage& coverage) {
  std::set<std::string> failing;
  for (const validate::CoverageFailure& one : validate::too_narrow(coverage)) {
    failing.insert(fmt::format("{} of {} {}", symbol_of(one.row.quantity), one.row.configuration,
                               by_estimator(one.row.estimator)));
  }
  return failing;
}

/// "The stated 95 % intervals contain the true value in 93.5 to 95.0 % of 200 replicates, as often as stated, …" or
/// "…, less often than stated for 1 of 2". `judged` is not empty.
std::string holding_words(const validate::Coverage& coverage, const std::vector<const validate::CoverageRow*>& judged,
                          std::size_t failing) {
  const auto [least, most] = std::minmax_element(
      judged.begin(), judged.end(), [](const auto* a, const auto* b) { return a->coverage < b->coverage; });
  return fmt::format("The stated 95 % intervals contain the true value in {:.1f} to {:.1f} % of {} replicates, {}",
                     100.0 * (*least)->coverage, 100.0 * (*most)->coverage, coverage.replicates,
                     failing == 0 ? "as often as stated, as far as this many replicates can tell"
                                  : fmt::format("less often than stated for {} of {}", failing, judged.size()));
}

std::string coverage_meaning(const validate::Coverage& coverage) {
  const auto narrow = validate::too_narrow(coverage), wide = validate::too_wide(coverage);
  const std::vector<const validate::CoverageRow*> judged = judged_rows(coverage);
  std::string text;
  if (coverage.outside && coverage.outside->failed() > 0) {
    text += fmt::format("<p><b>{}</b></p>\n", escape(outside_failed(*coverage.outside)));
  }
  if (judged.empty()) {
    return meaning_section(
        text +
        "<p>There is nothing to count: no estimator found a value whose truth is known. K/m and µ have a true value "
        "only for viscous drag with Coulomb friction; under another law only the inclination α has one, and the "
        "terminal velocity where the forces balance, and these motions do not determine them.</p>\n");
  }
  text += fmt::format("<p><b>{}.</b></p>\n", escape(holding_words(coverage, judged, failing_rows(coverage).size())));
  if (!narrow.empty()) {
    text += "<p>These hold less often than stated (how often, at each stated level):</p>\n" + failures_html(narrow);
  }
  if (!wide.empty()) {
    text +=
        "<p>These are wider than they need to be, and contain the true value more often:</p>\n" + failures_html(wide);
  }
  const std::vector<validate::CoverageRow> astray = scattered(coverage);
  if (!astray.empty()) {
    text += fmt::format(
        "<p>The values scatter more than {} times as much as stated for {}. A few replicates lie far off, too few to "
        "affect the coverage of 95 % intervals: record such a motion more than once.</p>\n",
        base::number_text(kMostScatterOverStated, 2), astray_list(astray));
  }
  text +=
      "<p>The naive lines treat smoothed points as if they were independent. They are shown to demonstrate what that "
      "does to an interval.</p>\n";
  return meaning_section(text);
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
  document["levels"] = coverage.levels;
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
      object["levels"] = Json::array();
      for (const validate::LevelCount& at : row.levels) {
        object["levels"].push_back({{"level", at.level},
                                    {"covered", at.covered},
                                    {"coverage", at.coverage},
                                    {"coverage_interval95", {at.low95, at.high95}},
                                    {"p_value", at.p_value}});
      }
    }
    put(object, "cramer_rao_sd", row.cramer_rao_sd,
        "the motion does not determine it, or the law is not viscous drag with Coulomb friction");
    put(object, "efficiency", row.efficiency, "no bound, or no value");
    document["quantities"].push_back(std::move(object));
  }
  if (coverage.outside) document["outside"] = outside_json(*coverage.outside);
  return json_text(document);
}

std::string coverage_answer(const validate::Coverage& coverage) {
  const std::vector<const validate::CoverageRow*> judged = judged_rows(coverage);
  const std::string failed = coverage.outside ? outside_failed(*coverage.outside) : std::string();
  if (judged.empty()) return failed;
  const std::set<std::string> failing = failing_rows(coverage);
  return (failed.empty() ? failed : failed + " ") + holding_words(coverage, judged, failing.size()) +
         (failing.empty() ? "" : fmt::format(": {}", fmt::join(failing, "; "))) + ".";
}

namespace {

/// The rows of one quantity of one configuration, an estimator each. The page has all columns, and every level.
std::string quantity_text(const std::vector<const validate::CoverageRow*>& of) {
  std::vector<std::vector<std::string>> rows = {{"estimator", "bias", "sd", "stated sd", "coverage (95 % interval)"}};
  for (const validate::CoverageRow* row : of) {
    const std::vector<std::string> cells = cells_of(*row);
    rows.push_back({row->estimator, cells[kBias], cells[kSd], cells[kStatedSd], cells[kCoverage]});
  }
  const validate::CoverageRow& first = *of.front();
  return fmt::format("\n{}, {} = {}{}:\n{}", base::printable_text(first.configuration), symbol_of(first.quantity),
                     base::value_text(first.truth, first.sd), unit_suffix(unit_of(first.quantity)),
                     text_table(rows, 1));
}

}  // namespace

std::string coverage_text(const validate::Coverage& coverage) {
  std::vector<std::vector<const validate::CoverageRow*>> tables;
  for (const validate::CoverageRow& row : coverage.rows) {
    const auto same = std::ranges::find_if(tables, [&](const auto& of) {
      return of.front()->configuration == row.configuration && of.front()->quantity == row.quantity;
    });
    if (same == tables.end()) {
      tables.push_back({&row});
    } else {
      same->push_back(&row);
    }
  }
  const std::string answer = coverage_answer(coverage);
  std::string text = answer.empty() ? answer : answer + "\n";
  for (const auto& of : tables) text += quantity_text(of);
  if (coverage.outside) text += "\n" + outside_text(*coverage.outside) + "\n";
  return text;
}

Page coverage_page(const std::string& title, const validate::Coverage& coverage) {
  Html body = question_heading(title, "How often do the stated intervals contain the true value?") +
              coverage_meaning(coverage) +
              fmt::format(
                  "<p class=\"soft\">{} replicates of the scenario's motions as tracks, with {} of independent "
                  "noise in every position{}, a clock that is off by 20 ppm (one standard deviation) and no lost "
                  "frames, analysed "
                  "by each estimator.</p>\n",
                  coverage.replicates, noise_text(coverage),
                  coverage.camera_noise ? " (the least that the camera, the light and the marker allow)" : "");
  const bool any = std::any_of(coverage.rows.begin(), coverage.rows.end(),
                               [](const validate::CoverageRow& row) { return row.determined > 0; });
  if (any) body += figures({coverage_plot(coverage)});
  HtmlTable table({"quantity", "truth", "bias", "sd", "stated sd", "least sd", "efficiency", "coverage", "values"});
  table.stack_when_narrow(1);
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
  Html every = table.str();
  every +=
      "<p class=\"soft\">bias and sd are those of the values over the replicates, stated sd what the estimator says "
      "(root mean square), least sd the Cramér-Rao bound, efficiency least sd² / (sd² + bias²), coverage the fraction "
      "of 95 % intervals that contain the true value, with its own 95 % interval (Clopper and Pearson).</p>\n";
  body += folded("Every quantity", every);
  if (coverage.outside) body += fmt::format("<p>{}.</p>\n", escape(outside_text(*coverage.outside)));
  if (!coverage.levels.empty()) {
    Html levels = any ? figures({reliability_plot(coverage)}) : Html();
    levels += level_table(coverage);
    body += folded("Every level, from the narrowest intervals to the widest", levels);
  }
  return page(title, body);
}

}  // namespace glidelab::report
