#include "report/coverage/coverage_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "report/html/gnuplot.h"
#include "report/html/plot_style.h"
#include "report/text/quantity_names.h"

namespace glidelab::report {

Plot coverage_plot(const validate::Coverage& coverage) {
  std::string tics, script(kFrame);
  std::vector<PlotData> data;
  const std::vector<std::string> estimators = validate::coverage_estimators();
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

Plot reliability_plot(const validate::Coverage& coverage) {
  // A column of the plot for each level: over the level itself 90, 95 and 99 % would lie over each other.
  PlotData band{"band", {}}, stated{"stated", {}};
  std::string tics;
  const std::vector<std::string> estimators = validate::coverage_estimators();
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
          "set xlabel 'level that the intervals state  (%)'\n"
          "set ylabel 'intervals that hold the truth  (%)'\n"
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
  return {Drawing{script, data, {560, 480}},
          fmt::format("How many of the intervals of each level hold the truth: a point for each quantity, the "
                      "estimators side by side; grey: what 95 % of {} replicates do by chance where the intervals are "
                      "right",
                      coverage.replicates),
          "Reliability: actual over nominal coverage"};
}

}  // namespace glidelab::report
