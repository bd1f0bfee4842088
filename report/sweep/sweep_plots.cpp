#include "report/sweep/sweep_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/math/distributions.h"
#include "fit/estimators.h"
#include "report/html/gnuplot.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

using validate::AxisSummary;
using validate::Series;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

constexpr double kPlotWidth = 360.0;  // points between the axis' ends

/// Words are placed side by side.
std::string axis_of_words(const AxisSummary& axis) {
  std::string script = "set xtics rotate by -35 left font ',10'\nset xtics (";
  for (std::size_t i = 0; i < axis.labels.size(); ++i) {
    script += fmt::format("{}{} {}", i == 0 ? "" : ", ", gnuplot_quoted(axis.labels[i]), i);
  }
  return script +
         fmt::format(")\nset xrange [-0.5:{}]\nset bmargin 8\n", static_cast<double>(axis.labels.size()) - 0.5);
}

/// For errors, a range that begins and ends at 1, 2 or 5 times a power of ten, with these labelled, or only powers of
/// ten if there are many.
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
  std::vector<double> ladder = ladder_of(least / kRoom, most * kRoom);
  const double from = ladder.front(), to = ladder.back();
  if (ladder.size() > kMost) {
    std::erase_if(ladder, [](double value) { return std::abs(std::remainder(std::log10(value), 1.0)) > 1e-6; });
  }
  return fmt::format("set yrange [{:.6g}:{:.6g}]\n", from, to) + labelled_tics("y", ladder);
}

bool whole(const validate::Likeness& of) {
  return of.whole || (of.alike > 0 && of.alike == of.combinations);
}

/// The runs that lines refer to, if some runs have no answer: in the caption (`common`) if it is the same for all,
/// otherwise next to each name.
struct RunNotes {
  std::string common;
  std::vector<std::string> of_each;
};

RunNotes notes_of(const std::vector<const Series*>& drawn) {
  const auto same = [](const validate::Likeness& a, const validate::Likeness& b) {
    return whole(a) == whole(b) && a.alike == b.alike && a.combinations == b.combinations;
  };
  bool one = true, of_alike = false, of_unlike = false;
  for (const Series* const series : drawn) {
    one = one && same(series->likeness, drawn.front()->likeness);
    if (!whole(series->likeness)) (series->likeness.alike > 0 ? of_alike : of_unlike) = true;
  }
  RunNotes notes{{}, std::vector<std::string>(drawn.size())};
  if (of_alike) {
    const validate::Likeness& of = drawn.front()->likeness;
    notes.common +=
        fmt::format("; {} combinations of the other keys that have a result at every value",
                    one ? fmt::format("over those {} of {}", of.alike, of.combinations) : "n of m: over those");
  }
  if (of_unlike) {
    notes.common += one ? "; some runs have no result, so the runs at two values are not comparable"
                        : "; unlike runs: some have no result, so the runs at two values are not comparable";
  }
  for (std::size_t i = 0; i < drawn.size() && !one; ++i) {
    const validate::Likeness& of = drawn[i]->likeness;
    if (whole(of)) continue;
    notes.of_each[i] = of.alike > 0 ? fmt::format(", {} of {}", of.alike, of.combinations) : ", unlike runs";
  }
  return notes;
}

/// The 95 % interval of a proportion, in per cent (Wilson 1927): within 0 and 100 even for few runs.
std::pair<double, double> wilson_percent(double part, double count) {
  constexpr double z = base::kNormal95;
  const double centre = part + z * z / (2.0 * count);
  const double reach = z * std::sqrt(part * (1.0 - part) / count + z * z / (4.0 * count * count));
  const double whole_of = 1.0 + z * z / count;
  return {100.0 * (centre - reach) / whole_of, 100.0 * (centre + reach) / whole_of};
}

/// The drawn data of a quantity: each series that has an answer, and its block of numbers.
struct Drawn {
  std::vector<const Series*> series;
  std::vector<PlotData> data;
};

/// Columns: position, rms, sd, least sd, bias, two standard errors of it, coverage, its 95 % interval (two columns).
Drawn drawn_of(const std::vector<Series>& all, std::string_view quantity) {
  Drawn drawn;
  for (const Series& series : all) {
    if (series.quantity != quantity) continue;
    PlotData block{fmt::format("series{}", drawn.data.size()), {}};
    const validate::Likeness& likeness = series.likeness;
    for (const validate::GroupStatistics& group : series.groups) {
      const bool alike = likeness.whole || likeness.alike > 0;
      if (alike && validate::comparable(series, group) == nullptr) continue;
      const validate::ErrorStatistics& of = alike ? *validate::comparable(series, group) : group.statistics;
      if (of.answered == 0) continue;
      const auto [low, high] = wilson_percent(of.coverage, static_cast<double>(of.answered));
      block.rows.push_back({group.position, of.rms > 0.0 ? of.rms : kNan, of.sd > 0.0 ? of.sd : kNan,
                            of.least_sd.value_or(kNan), of.bias, 2.0 * of.bias_sd, 100.0 * of.coverage, low, high});
    }
    if (block.rows.empty()) continue;
    drawn.series.push_back(&series);
    drawn.data.push_back(std::move(block));
  }
  return drawn;
}

/// Last column: the position of a point with a bar, next to those of the others.
std::vector<PlotData> with_places(std::vector<PlotData> data, const AxisSummary& axis, const ValueAxis& values) {
  for (std::size_t i = 0; i < data.size(); ++i) {
    for (std::vector<double>& row : data[i].rows) {
      const double aside = static_cast<double>(i) - 0.5 * (static_cast<double>(data.size()) - 1.0);
      const double step = std::min(0.12, 0.7 / static_cast<double>(data.size()));
      row.push_back(axis.words ? row.front() + step * aside : values.beside(row.front(), i, data.size()));
    }
  }
  return data;
}

/// The series' names in the legend. If there are many in one plot, lines are named only by their rule, as the caption
/// explains.
struct Titles {
  std::vector<std::string> of_each;
  bool shortened = false;
};

Titles titles_of(const std::vector<const Series*>& drawn) {
  constexpr std::size_t kLeastManySeries = 5;
  const std::string lines = std::string(fit::default_estimator().name) + " ";
  Titles titles;
  for (const Series* const series : drawn) {
    const bool by_rule = drawn.size() >= kLeastManySeries && series->estimator.starts_with(lines);
    titles.of_each.push_back(by_rule ? series->estimator.substr(lines.size()) : series->estimator);
    titles.shortened = titles.shortened || by_rule;
  }
  return titles;
}

/// One axis' plots of one quantity: the legend, their common elements, and their height.
struct Frame {
  std::vector<PlotData> data;
  std::vector<std::string> titles;
  std::string script;
  std::string line;  ///< how values are joined
  std::string note;  ///< for the caption
  PlotSize size;
  std::size_t values = 0;  ///< number of the axis' values that have an answer
};

Frame frame_of(const AxisSummary& axis, const std::vector<Series>& all, std::string_view quantity) {
  Frame frame;
  Drawn drawn = drawn_of(all, quantity);
  std::vector<double> positions;
  for (const PlotData& block : drawn.data) {
    for (const std::vector<double>& row : block.rows) positions.push_back(row.front());
  }
  if (positions.empty()) return frame;
  const ValueAxis values(positions, axis.logarithmic && !axis.words);
  frame.values = values.size();
  frame.data = with_places(std::move(drawn.data), axis, values);
  const Titles titles = titles_of(drawn.series);
  const RunNotes notes = notes_of(drawn.series);
  for (std::size_t i = 0; i < drawn.series.size(); ++i) {
    frame.titles.push_back(titles.of_each[i] + notes.of_each[i]);
  }
  frame.note = notes.common;
  if (titles.shortened) frame.note += "; entries named by a rule or h alone are lines of the phase diagram";
  // gnuplot makes the legend's columns as wide as its longest text: about 7.5 points per letter at this size, plus its
  // sample.
  std::size_t longest = std::string_view("stated sd (dashed)").size();
  for (const std::string& title : frame.titles) longest = std::max(longest, title.size());
  constexpr int kWidth = 480, kRow = 17, kEdge = 14;  // points
  const int columns = std::max(1, static_cast<int>((kWidth - 20) / (7.5 * static_cast<double>(longest) + 50.0)));
  const int rows = (static_cast<int>(frame.titles.size()) + 2 + columns - 1) / columns;
  frame.size = {kWidth, (axis.words ? 400 : 290) + kRow * rows + kEdge};
  // Centred on the plot: centred on the axes it would be cut off at the right.
  frame.script = std::string(kFrame) +
                 fmt::format("set key at screen 0.5, screen {:.4f} center top font ',11' maxcols {} samplen 1\n",
                             1.0 - 4.0 / static_cast<double>(frame.size.height), columns) +
                 fmt::format("set xlabel {} offset 0,0.3\n", gnuplot_quoted(with_unit(axis.name, axis.unit))) +
                 (axis.words ? axis_of_words(axis) : values.script(kPlotWidth));
  // gnuplot reserves no room for a legend of many rows, so it is reserved here.
  frame.script += fmt::format("set tmargin at screen {:.4f}\n",
                              1.0 - static_cast<double>(kRow * rows + kEdge) / static_cast<double>(frame.size.height));
  frame.line = axis.words ? "points" : "linespoints";
  return frame;
}

/// If colours repeat: squares instead of discs.
int shape_of(std::size_t i) {
  return i < kColors.size() ? 7 : 5;
}

/// `of`: the configuration; empty for all.
Plot error_plot(const AxisSummary& axis, const std::vector<Series>& all, std::string_view quantity,
                const std::string& of) {
  const Frame frame = frame_of(axis, all, quantity);
  const std::string symbol = symbol_of(quantity);
  std::string script =
      frame.script + fmt::format(
                         "set ylabel {}\nset logscale y\nset offsets 0,0,0,0\n"
                         "{}plot ",
                         gnuplot_quoted(with_unit("error of " + symbol, unit_of(quantity))), error_axis(frame.data));
  bool bound = false;
  const char* const x = axis.words ? "10" : "1";  // points for words, side by side; lines over the value itself
  const std::string sd = axis.words ? "hollow" : "dashed";
  for (std::size_t i = 0; i < frame.data.size(); ++i) {
    script += fmt::format(
        "{0}${1} using {7}:2 with {2} pt {6} ps 0.5 lw 1.6 lc rgb '{3}' title {4}, "
        "${1} using {7}:3 with {2} pt 6 ps 0.5 dt 2 lc rgb '{3}' {5}",
        i == 0 ? "" : ", ", frame.data[i].name, frame.line, color(i), gnuplot_quoted(frame.titles[i]),
        i == 0 ? fmt::format("title 'stated sd ({})'", sd) : "notitle", shape_of(i), x);
    for (const auto& row : frame.data[i].rows) bound = bound || std::isfinite(row[3]);
  }
  if (bound) {
    script += fmt::format(", ${} using 1:4 with {} pt 2 ps 0.6 dt 3 lc rgb '#000000' title 'least possible sd'",
                          frame.data[0].name, frame.line);
  }
  const std::string only = of.empty() ? "" : ", " + of;
  return {Drawing{script, frame.data, frame.size},
          fmt::format("Root mean square error ({}) and stated standard deviation ({}){}{}",
                      axis.words ? "filled" : "solid", sd, only, frame.note),
          fmt::format("Error of {} against {}{}", symbol, axis.name, only)};
}

Plot bias_plot(const AxisSummary& axis, const Frame& frame, std::string_view quantity) {
  constexpr int kMarks = 8;
  double least = 0.0, most = 0.0;
  for (const PlotData& block : frame.data) {
    for (const std::vector<double>& row : block.rows) {
      const double reach = std::isfinite(row[5]) ? row[5] : 0.0;
      least = std::min(least, row[4] - reach);
      most = std::max(most, row[4] + reach);
    }
  }
  const std::string symbol = symbol_of(quantity);
  std::string script = frame.script + fmt::format(
                                          "set ylabel {}\nset offsets 0,0,graph 0.06,graph 0.06\n"
                                          "set xzeroaxis lt 1 lc rgb '#555555'\n{}plot ",
                                          gnuplot_quoted(with_unit("mean error of " + symbol, unit_of(quantity))),
                                          most > least ? even_tics("y", least, most, kMarks) : "");
  for (std::size_t i = 0; i < frame.data.size(); ++i) {
    script += fmt::format(
        "{0}${1} using 10:5 with {2} pt {5} ps 0.5 lc rgb '{3}' title {4}, "
        "${1} using 10:5:6 with yerrorbars pt {5} ps 0.3 lc rgb '{3}' notitle",
        i == 0 ? "" : ", ", frame.data[i].name, frame.line, color(i), gnuplot_quoted(frame.titles[i]), shape_of(i));
  }
  return {Drawing{script, frame.data, frame.size}, "Mean error with two standard errors" + frame.note,
          fmt::format("Bias of {} against {}", symbol, axis.name)};
}

Plot coverage_plot(const AxisSummary& axis, const Frame& frame, std::string_view quantity) {
  double lowest = 90.0;
  for (const PlotData& block : frame.data) {
    for (const std::vector<double>& row : block.rows) lowest = std::min(lowest, row[7]);
  }
  std::string script = frame.script + fmt::format(
                                          "set ylabel 'coverage (%)'\nset offsets 0,0,0,0\nset yrange [{:.4g}:101]\n"
                                          "plot 95 with lines dt 3 lc rgb '#555555' title 'nominal'",
                                          std::max(0.0, 10.0 * std::floor(lowest / 10.0)));
  for (std::size_t i = 0; i < frame.data.size(); ++i) {
    script += fmt::format(", ${0} using 10:7:8:9 with yerrorbars pt {3} ps 0.5 lc rgb '{1}' title {2}",
                          frame.data[i].name, color(i), gnuplot_quoted(frame.titles[i]), shape_of(i));
  }
  return {Drawing{script, frame.data, frame.size},
          "Coverage of the stated intervals, with its own 95 % interval" + frame.note,
          fmt::format("Coverage of {} against {}", symbol_of(quantity), axis.name)};
}

}  // namespace

std::vector<Plot> sweep_plots(const AxisSummary& axis, std::string_view quantity,
                              std::span<const validate::ConfigurationSummary> configurations) {
  const Frame frame = frame_of(axis, axis.series, quantity);
  if (frame.values < 2) return {};
  std::vector<Plot> plots;
  for (std::size_t c = 0; c < axis.of_configurations.size(); ++c) {
    if (frame_of(axis, axis.of_configurations[c], quantity).values < 2) continue;
    plots.push_back(error_plot(axis, axis.of_configurations[c], quantity, configurations[c].name));
  }
  if (plots.empty()) plots.push_back(error_plot(axis, axis.series, quantity, {}));
  plots.push_back(bias_plot(axis, frame, quantity));
  plots.push_back(coverage_plot(axis, frame, quantity));
  return plots;
}

}  // namespace glidelab::report
