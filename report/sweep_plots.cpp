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

/// What of the runs a line is of, where some have no answer.
std::string part_of(const Series& series) {
  const validate::Likeness& of = series.likeness;
  if (of.whole || (of.alike > 0 && of.alike == of.combinations)) return {};
  if (of.alike > 0) return fmt::format(", {} of {}", of.alike, of.combinations);
  return ", unlike runs";
}

/// For the caption: what part_of() says.
std::string note_of(const std::vector<Series>& all, std::string_view quantity) {
  std::string note;
  bool of_alike = false, of_unlike = false;
  for (const Series& series : all) {
    if (series.quantity != quantity || part_of(series).empty()) continue;
    (series.likeness.alike > 0 ? of_alike : of_unlike) = true;
  }
  if (of_alike)
    note += "; n of m: over those combinations of the other keys and configurations that have an answer at every value";
  if (of_unlike) note += "; unlike runs: some have no answer, so that those at two values are not alike";
  return note;
}

/// Columns: position, rms, sd, least sd, bias, two standard errors of it, coverage, two standard errors of it.
std::vector<PlotData> data_of(const std::vector<Series>& all, std::string_view quantity,
                              std::vector<std::string>& titles) {
  std::vector<PlotData> data;
  for (const Series& series : all) {
    if (series.quantity != quantity) continue;
    PlotData block{fmt::format("series{}", data.size()), {}};
    const validate::Likeness& likeness = series.likeness;
    for (const validate::GroupStatistics& group : series.groups) {
      const bool alike = likeness.whole || likeness.alike > 0;
      if (alike && validate::comparable(series, group) == nullptr) continue;
      const validate::ErrorStatistics& of = alike ? *validate::comparable(series, group) : group.statistics;
      if (of.answered == 0) continue;
      // Where all or no intervals hold the truth the binomial error is that of one more run each way.
      const double n = static_cast<double>(of.answered), p = (of.coverage * n + 1.0) / (n + 2.0);
      block.rows.push_back({group.position, of.rms > 0.0 ? of.rms : kNone, of.sd > 0.0 ? of.sd : kNone,
                            of.least_sd.value_or(kNone), of.bias, 2.0 * of.bias_sd, 100.0 * of.coverage,
                            200.0 * std::sqrt(p * (1.0 - p) / n)});
    }
    if (block.rows.empty()) continue;
    titles.push_back(series.estimator + part_of(series));
    data.push_back(std::move(block));
  }
  return data;
}

/// Where the lines of many rules stand in one plot, these by their rule alone, as the caption says.
bool shorten(std::vector<std::string>& titles) {
  constexpr std::size_t kMany = 5;
  constexpr std::string_view kLines = "phase-diagram ";
  if (titles.size() < kMany) return false;
  bool any = false;
  for (std::string& title : titles) {
    if (!title.starts_with(kLines)) continue;
    title.erase(0, kLines.size());
    any = true;
  }
  return any;
}

/// One axis' plots of one quantity: the legend, what is common to them, and how high they are.
struct Frame {
  std::vector<PlotData> data;
  std::vector<std::string> titles;
  std::string script;
  std::string line;  ///< how values are joined
  std::string note;  ///< for the caption
  PlotSize size;
};

Frame frame_of(const AxisSummary& axis, const std::vector<Series>& all, std::string_view quantity) {
  Frame frame;
  frame.data = data_of(all, quantity, frame.titles);
  if (frame.data.empty()) return frame;
  frame.note = note_of(all, quantity);
  if (shorten(frame.titles)) frame.note += "; what is named by a rule or h alone are lines of the phase diagram";
  // gnuplot makes the legend's columns as wide as its longest text: some 7.5 points a letter at this size, and its
  // sample.
  std::size_t longest = std::string_view("stated sd (dashed)").size();
  for (const std::string& title : frame.titles) longest = std::max(longest, title.size());
  constexpr int kWidth = 480, kRow = 17, kEdge = 14;  // points
  const int columns = std::max(1, static_cast<int>((kWidth - 20) / (7.5 * static_cast<double>(longest) + 50.0)));
  const int rows = (static_cast<int>(frame.titles.size()) + 2 + columns - 1) / columns;
  frame.size = {kWidth, (axis.words ? 400 : 290) + kRow * rows + kEdge};
  frame.script = std::string(kFrame) + fmt::format("set key font ',11' maxcols {} samplen 1\n", columns) + x_axis(axis);
  // gnuplot takes no room for a legend of many rows: it is left here.
  frame.script += fmt::format("set tmargin at screen {:.4f}\n",
                              1.0 - static_cast<double>(kRow * rows + kEdge) / static_cast<double>(frame.size.height));
  if (!axis.words && axis.logarithmic) frame.script += tics_of_values(frame.data);
  frame.line = axis.words ? "points" : "linespoints";
  return frame;
}

/// Where colours come again: squares in place of discs.
int shape_of(std::size_t i) {
  return i < kColors.size() ? 7 : 5;
}

/// `of`: of which configuration; empty of all.
Plot error_plot(const AxisSummary& axis, const std::vector<Series>& all, std::string_view quantity,
                const std::string& of) {
  const Frame frame = frame_of(axis, all, quantity);
  const std::string symbol = symbol_of(quantity);
  std::string script =
      frame.script + fmt::format(
                         "set ylabel {}\nset logscale y\nset format y '%g'\nset offsets 0,0,0,0\n"
                         "{}plot ",
                         gnuplot_quoted(with_unit("error of " + symbol, unit_of(quantity))), error_axis(frame.data));
  bool bound = false;
  for (std::size_t i = 0; i < frame.data.size(); ++i) {
    script += fmt::format(
        "{0}${1} using 1:2 with {2} pt {6} ps 0.5 lw 1.6 lc rgb '{3}' title {4}, "
        "${1} using 1:3 with {2} pt 6 ps 0.5 dt 2 lc rgb '{3}' {5}",
        i == 0 ? "" : ", ", frame.data[i].name, frame.line, color(i), gnuplot_quoted(frame.titles[i]),
        i == 0 ? "title 'stated sd (dashed)'" : "notitle", shape_of(i));
    for (const auto& row : frame.data[i].rows) bound = bound || std::isfinite(row[3]);
  }
  if (bound) {
    script += fmt::format(", ${} using 1:4 with {} pt 2 ps 0.6 dt 3 lc rgb '#000000' title 'least possible sd'",
                          frame.data[0].name, frame.line);
  }
  const std::string only = of.empty() ? "" : ", " + of;
  return {Drawing{script, frame.data, frame.size},
          "Root mean square error (solid) and stated standard deviation (dashed)" + only + frame.note,
          fmt::format("Error and standard deviation of {} over {}{}", symbol, axis.name, only)};
}

Plot bias_plot(const AxisSummary& axis, const Frame& frame, std::string_view quantity) {
  const std::string symbol = symbol_of(quantity);
  std::string script =
      frame.script + fmt::format("set ylabel {}\nset xzeroaxis lt 1 lc rgb '#555555'\nplot ",
                                 gnuplot_quoted(with_unit("mean error of " + symbol, unit_of(quantity))));
  for (std::size_t i = 0; i < frame.data.size(); ++i) {
    script += fmt::format(
        "{0}${1} using 1:5 with {2} pt {5} ps 0.5 lc rgb '{3}' title {4}, "
        "${1} using 1:5:6 with yerrorbars pt {5} ps 0.3 lc rgb '{3}' notitle",
        i == 0 ? "" : ", ", frame.data[i].name, frame.line, color(i), gnuplot_quoted(frame.titles[i]), shape_of(i));
  }
  return {Drawing{script, frame.data, frame.size}, "Mean error with two standard errors" + frame.note,
          fmt::format("Bias of {} over {}", symbol, axis.name)};
}

Plot coverage_plot(const AxisSummary& axis, const Frame& frame, std::string_view quantity) {
  std::string script = frame.script +
                       "set ylabel 'coverage (%)'\nset offsets graph 0.02, graph 0.02, 0, 0\nset yrange [0:102]\n"
                       "plot 95 with lines dt 3 lc rgb '#555555' title 'nominal'";
  for (std::size_t i = 0; i < frame.data.size(); ++i) {
    script += fmt::format(", ${0} using 1:7:8 with yerrorbars pt {3} ps 0.5 lc rgb '{1}' title {2}", frame.data[i].name,
                          color(i), gnuplot_quoted(frame.titles[i]), shape_of(i));
  }
  return {Drawing{script, frame.data, frame.size},
          "Coverage of the stated intervals, with two standard errors" + frame.note,
          fmt::format("Coverage of {} over {}", symbol_of(quantity), axis.name)};
}

}  // namespace

std::vector<Plot> sweep_plots(const AxisSummary& axis, std::string_view quantity,
                              std::span<const validate::ConfigurationSummary> configurations) {
  const Frame frame = frame_of(axis, axis.series, quantity);
  if (frame.data.empty()) return {};
  std::vector<Plot> plots;
  for (std::size_t c = 0; c < axis.of_configurations.size(); ++c) {
    std::vector<std::string> titles;
    if (data_of(axis.of_configurations[c], quantity, titles).empty()) continue;
    plots.push_back(error_plot(axis, axis.of_configurations[c], quantity, configurations[c].name));
  }
  if (plots.empty()) plots.push_back(error_plot(axis, axis.series, quantity, {}));
  plots.push_back(bias_plot(axis, frame, quantity));
  plots.push_back(coverage_plot(axis, frame, quantity));
  return plots;
}

}  // namespace glidelab::report
