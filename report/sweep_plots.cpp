#include "report/sweep_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "report/gnuplot.h"
#include "report/plot_style.h"
#include "report/quantity_names.h"

namespace glidelab::report {
namespace {

using validate::AxisSummary;
using validate::Series;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} ({})", name, unit);
}

/// The axis of the varied key: numbers, or the words one beside the other.
std::string x_axis(const AxisSummary& axis) {
  std::string script = fmt::format("set xlabel {} offset 0,0.3\n", gnuplot_quoted(with_unit(axis.name, axis.unit)));
  if (axis.words) {
    script += "set xtics rotate by -35 left font ',10'\nset xtics (";
    for (std::size_t i = 0; i < axis.labels.size(); ++i) {
      script += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_quoted(axis.labels[i]), i);
    }
    script += fmt::format(")\nset xrange [-0.5:{}]\nset bmargin 8\n", static_cast<double>(axis.labels.size()) - 0.5);
  } else if (axis.logarithmic) {
    script += "set logscale x\nset format x '%g'\nset xrange [*:*] noextend\n";
  }
  return script;
}

/// On a logarithmic axis of less than a few decades gnuplot labels hardly anything: the values that were run, where
/// they are few.
std::string tics_of_values(const std::vector<PlotData>& data) {
  constexpr std::size_t kMost = 7;  // labels that stand apart in a plot of 480 points
  std::set<double> values;
  for (const PlotData& block : data) {
    for (const std::vector<double>& row : block.rows) values.insert(row.front());
  }
  if (values.size() > kMost) return {};
  std::string tics;  // placed to the digits that the data are written with: one outside of the axis is not drawn
  for (const double value : values) {
    tics += fmt::format("{}'{:.4g}' {:.7g}", tics.empty() ? "" : ", ", value, value);
  }
  return fmt::format("set xtics ({})\n", tics);
}

/// The same for errors: a range that begins and ends at 1, 2 or 5 times a power of ten, with these labelled, or with
/// powers of ten alone where those are many.
std::string error_axis(const std::vector<PlotData>& data) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const PlotData& block : data) {
    for (const std::vector<double>& row : block.rows) {
      for (const double value : {row[1], row[2], row[3]}) {
        if (!(value > 0.0)) continue;
        least = std::min(least, value);
        most = std::max(most, value);
      }
    }
  }
  if (!(most > 0.0)) return "set yrange [*:*]\n";
  constexpr std::size_t kMost = 9;
  constexpr double kRoom = 1.02;  // a point on the edge would be cut in half
  std::vector<double> ladder;
  for (int power = static_cast<int>(std::floor(std::log10(least))) - 1; std::pow(10.0, power) < 10.0 * most; ++power) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double next = digit * std::pow(10.0, power);
      if (!ladder.empty() && ladder.back() >= kRoom * most) break;
      if (next * kRoom <= least) ladder.clear();
      ladder.push_back(next);
    }
  }
  const double from = ladder.front(), to = ladder.back();
  if (ladder.size() > kMost) {
    std::erase_if(ladder, [](double value) { return std::abs(std::remainder(std::log10(value), 1.0)) > 1e-6; });
  }
  return fmt::format("set yrange [{:.6g}:{:.6g}]\nset ytics ({:.6g})\n", from, to, fmt::join(ladder, ", "));
}

/// Columns: position, rms, sd, least sd, bias, two standard errors of it, coverage, two standard errors of it.
std::vector<PlotData> data_of(const AxisSummary& axis, std::string_view quantity, std::vector<std::string>& titles) {
  std::vector<PlotData> data;
  for (const Series& series : axis.series) {
    if (series.quantity != quantity) continue;
    PlotData block{fmt::format("series{}", data.size()), {}};
    for (const validate::GroupStatistics& group : series.groups) {
      const validate::ErrorStatistics& of = group.statistics;
      if (of.answered == 0) continue;
      // Where all or no intervals hold the truth the binomial error is that of one more run each way.
      const double n = static_cast<double>(of.answered), p = (of.coverage * n + 1.0) / (n + 2.0);
      block.rows.push_back({group.position, of.rms > 0.0 ? of.rms : kNone, of.sd > 0.0 ? of.sd : kNone,
                            of.least_sd.value_or(kNone), of.bias, 2.0 * of.bias_sd, 100.0 * of.coverage,
                            200.0 * std::sqrt(p * (1.0 - p) / n)});
    }
    if (block.rows.empty()) continue;
    titles.push_back(series.estimator);
    data.push_back(std::move(block));
  }
  return data;
}

}  // namespace

std::vector<Plot> sweep_plots(const AxisSummary& axis, std::string_view quantity) {
  std::vector<std::string> titles;
  const std::vector<PlotData> data = data_of(axis, quantity, titles);
  if (data.empty()) return {};
  const std::string symbol = symbol_of(quantity), unit = unit_of(quantity);
  std::string frame = std::string(kFrame) + "set key font ',11' maxcols 2 samplen 1\n" + x_axis(axis);
  if (!axis.words && axis.logarithmic) frame += tics_of_values(data);
  std::string errors = frame + fmt::format(
                                   "set ylabel {}\nset logscale y\nset format y '%g'\nset offsets 0,0,0,0\n"
                                   "{}plot ",
                                   gnuplot_quoted(with_unit("error of " + symbol, unit)), error_axis(data));
  std::string bias = frame + fmt::format("set ylabel {}\nset xzeroaxis lt 1 lc rgb '#555555'\nplot ",
                                         gnuplot_quoted(with_unit("mean error of " + symbol, unit)));
  std::string coverage = frame +
                         "set ylabel 'coverage (%)'\nset offsets graph 0.02, graph 0.02, 0, 0\nset yrange [0:102]\n"
                         "plot 95 with lines dt 3 lc rgb '#555555' title 'nominal'";
  const std::string line = axis.words ? "points" : "linespoints";
  bool bound = false;
  for (std::size_t i = 0; i < data.size(); ++i) {
    const std::string ink = color(i), title = gnuplot_quoted(titles[i]), comma = i == 0 ? "" : ", ";
    const int shape = i < kColors.size() ? 7 : 5;  // where colours come again: squares in place of discs
    errors += fmt::format(
        "{0}${1} using 1:2 with {2} pt {6} ps 0.5 lw 1.6 lc rgb '{3}' title {4}, "
        "${1} using 1:3 with {2} pt 6 ps 0.5 dt 2 lc rgb '{3}' {5}",
        comma, data[i].name, line, ink, title, i == 0 ? "title 'stated sd (dashed)'" : "notitle", shape);
    bias += fmt::format(
        "{0}${1} using 1:5 with {2} pt {5} ps 0.5 lc rgb '{3}' title {4}, "
        "${1} using 1:5:6 with yerrorbars pt {5} ps 0.3 lc rgb '{3}' notitle",
        comma, data[i].name, line, ink, title, shape);
    coverage += fmt::format(", ${0} using 1:7:8 with yerrorbars pt {3} ps 0.5 lc rgb '{1}' title {2}", data[i].name,
                            ink, title, shape);
    for (const auto& row : data[i].rows) bound = bound || std::isfinite(row[3]);
  }
  if (bound) {
    errors += fmt::format(", ${} using 1:4 with {} pt 2 ps 0.6 dt 3 lc rgb '#000000' title 'least possible sd'",
                          data[0].name, line);
  }
  const int legend = 14 * static_cast<int>((data.size() + 2) / 2);
  const PlotSize size{480, (axis.words ? 420 : 310) + legend};
  const std::string over = fmt::format("{} over {}", symbol, axis.name);
  return {{Drawing{errors, data, size}, "Root mean square error (solid) and stated standard deviation (dashed)",
           "Error and standard deviation of " + over},
          {Drawing{bias, data, size}, "Mean error with two standard errors", "Bias of " + over},
          {Drawing{coverage, data, size}, "Coverage of the stated intervals, with two standard errors",
           "Coverage of " + over}};
}

}  // namespace glidelab::report
