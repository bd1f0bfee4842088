#include "report/validation/validation_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fit/estimators.h"
#include "report/analysis/pixel_phase.h"
#include "report/html/decimate.h"
#include "report/html/gnuplot.h"
#include "report/html/plot_axis.h"
#include "report/html/plot_style.h"
#include "report/text/quantity_names.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kRestitutionPoints = 2000;
constexpr std::size_t kMostNamed = kColors.size();  // clips of which each has a colour of its own

/// One row a quantity, one colour a kind of quantity, filled for the lines' values and open for the whole motion's;
/// the page's reader looks for points beyond the band of ±2.
std::vector<Plot> error_plot(const validate::Comparison& comparison) {
  std::map<std::string, PlotData> by_quantity;
  std::vector<std::string> order;
  std::string tics;
  std::map<std::pair<std::string, std::string>, double> row_of;  // configuration and quantity
  std::map<std::string, bool> open;                              // by the name of the data
  double widest = 3.0;
  for (const validate::QuantityComparison& quantity : comparison.quantities) {
    if (!quantity.error || !quantity.sd || !(*quantity.sd > 0.0)) continue;
    const fit::Estimator* const estimator = fit::find_estimator(quantity.estimator);
    const bool whole_motion = estimator != nullptr && !estimator->of_lines;
    const std::string kind = quantity.quantity + (whole_motion ? " whole" : "");
    if (!by_quantity.contains(kind)) {
      order.push_back(kind);
      by_quantity[kind].name = fmt::format("q{}", order.size());
      by_quantity[kind].columns = {fmt::format("error of {} / standard deviation", symbol_of(quantity.quantity)),
                                   "row"};
      open[kind] = whole_motion;
    }
    const auto [place, added] =
        row_of.try_emplace({quantity.configuration, quantity.quantity}, static_cast<double>(row_of.size() + 1));
    const double row = place->second;
    const double in_sd = *quantity.error / *quantity.sd;
    widest = std::max(widest, 1.1 * std::abs(in_sd));
    by_quantity[kind].rows.push_back({in_sd, row});
    if (!added) continue;
    tics += fmt::format(
        "{}{} {}", tics.empty() ? "" : ", ",
        gnuplot_quoted(fmt::format("{}  {}", shortened(quantity.configuration), symbol_of(quantity.quantity))), row);
  }
  if (order.empty()) return {};
  std::string script(kFrame);
  script += fmt::format(
      "unset offsets\nset xrange [{0:.4g}:{1:.4g}]\nset yrange [{2:.4g}:0.3]\nset ytics ({3})\n"
      "set xlabel 'error / standard deviation'\nunset key\n"
      "set object rectangle from -2, graph 0 to 2, graph 1 behind fillcolor rgb '#e3eef6' fillstyle solid noborder\n"
      "set arrow from 0, graph 0 to 0, graph 1 nohead back lw 1 lc rgb '#888888'\nplot ",
      -widest, widest, static_cast<double>(row_of.size()) + 0.7, tics);
  std::vector<PlotData> data;
  for (std::size_t n = 0; n < order.size(); ++n) {
    data.push_back(by_quantity[order[n]]);
    script += fmt::format("{}${} using 1:2 with points pt {} ps 0.9 lw 1.5 lc rgb '{}'", n == 0 ? "" : ", ",
                          data.back().name, open[order[n]] ? 6 : 7, color(n % 4));
  }
  const int height = std::max(330, 80 + static_cast<int>(row_of.size()) * 22);
  return {{Drawing{script, data, {480, height}},
           "Error of each recovered value in units of its own standard deviation; about 95 % should lie within the "
           "band. Filled: lines of the phase diagram; open: fit of the whole motion",
           "Errors in units of their standard deviation"}};
}

std::vector<Plot> restitution_plot(const core::AnalysisResults& results,
                                   const validate::RestitutionComparison& restitution) {
  if (restitution.points.empty()) return {};
  const auto [unit, scale] = small_length_unit(restitution.max_m);
  std::vector<PlotData> data;
  const bool named = results.clips.size() <= kMostNamed;
  std::string script(kFrame);
  script += fmt::format("set xlabel 'true x  (m)'\nset ylabel 'measured − true  ({})'\n{}plot ", unit,
                        named ? "set key noenhanced\n" : "unset key\n");
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    std::vector<const validate::RestitutionPoint*> own;
    for (const validate::RestitutionPoint& point : restitution.points) {
      if (point.clip == c) own.push_back(&point);
    }
    if (own.empty()) continue;
    PlotData block{fmt::format("clip{}", c),
                   {},
                   {"true x (m)", fmt::format("measured - true of {} ({})", results.clips[c].name, unit)}};
    for (const std::size_t i :
         every_nth(own.size(), std::max<std::size_t>(50, kRestitutionPoints / results.clips.size()))) {
      block.rows.push_back({own[i]->x_m, own[i]->error_m * scale});
    }
    script += fmt::format("{}${} using 1:2 with points pt 7 ps 0.25 lc rgb '{}' notitle", data.empty() ? "" : ", ",
                          block.name, color(c));
    if (named) {
      script += fmt::format(", keyentry with points pt 7 ps 0.8 lc rgb '{}' title {}", color(c),
                            gnuplot_quoted(shortened(results.clips[c].name)));
    }
    data.push_back(std::move(block));
  }
  return {
      {Drawing{script, data},
       fmt::format("Error of the measured position over the field, one colour per clip{}", named ? "" : ", in turn"),
       "Restitution error over the true position"}};
}

}  // namespace

std::vector<Plot> validation_plots(const core::AnalysisResults& results, const validate::Comparison& comparison) {
  std::vector<Plot> plots = error_plot(comparison);
  for (Plot& plot : restitution_plot(results, comparison.restitution)) plots.push_back(std::move(plot));
  for (Plot& plot : pixel_phase_plot(phase_points(results, comparison.restitution), true)) {
    plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace glidelab::report
