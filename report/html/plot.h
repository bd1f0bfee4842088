/// A plot before it is drawn: columns of numbers and the gnuplot commands that draw them, the colours and the frame
/// shared by all plots, axes whose labels do not overlap, and the choice of points of a long series.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidelab::report {

/// Columns of numbers under the name used in the script: `plot $name using 1:2`. NaN breaks a line.
struct PlotData {
  std::string name;
  std::vector<std::vector<double>> rows;  ///< an empty row stands for a blank line, which also breaks a line
  std::vector<std::string> columns = {};  ///< content of each, with its unit: "v (m/s)"; for readers of the file
};

/// gnuplot treats a block without rows as an error; one row of NaN, as wide as `columns`, draws nothing.
inline PlotData never_empty(PlotData data) {
  if (data.rows.empty()) {
    data.rows.push_back(std::vector<double>(data.columns.size(), std::numeric_limits<double>::quiet_NaN()));
  }
  return data;
}

/// Size in points of the plot's own coordinates; a page scales it.
struct PlotSize {
  int width = 480;
  int height = 330;
};

struct Drawing {
  std::string script;
  std::vector<PlotData> data;
  PlotSize size = {};
};

/// A plot as it appears on a page, with a text for readers who cannot see it.
struct Plot {
  Drawing drawing;
  std::string caption;      ///< HTML-free text under the plot
  std::string description;  ///< for the alt attribute; the plot's files are named after it
};

/// Colours that colour-blind readers can distinguish, also in grey print; Okabe and Ito, "Color universal design"
/// (2008), without the yellow, which is invisible on white paper.
inline constexpr std::array<std::string_view, 7> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                            "#56b4e9", "#e69f00", "#000000"};
/// Background or omitted data; the shading of such a stretch.
inline constexpr std::string_view kGrey = "#9a9a9a";
/// A thin or dotted grey line: dark enough to be seen on white paper and, inverted, on a dark page.
inline constexpr std::string_view kThinGrey = "#6b6b6b";
inline constexpr std::string_view kShade = "#ececec";

/// The colour of the n-th series; colours repeat after the last.
inline std::string color(std::size_t index) {
  return std::string(kColors[index % kColors.size()]);
}

/// Thin frame at the left and below, light grid, the legend above, and some room around the points.
inline constexpr std::string_view kFrame =
    "set border 3 lw 1 lc rgb '#555555'\n"
    "set tics nomirror out scale 0.6\n"
    "set grid xtics ytics back lw 0.6 lc rgb '#dddddd'\n"
    "set key outside top center horizontal samplen 1.2 width -1.5 font ',14'\n"
    "set xtics autofreq\nset ytics autofreq\n"
    "set pointintervalbox 0.01\n"  // 0 means 1: gnuplot clears a disc of that size below a point with bars, including
                                   // other bars in it
    "set offsets graph 0.02, graph 0.02, graph 0.06, graph 0.06\n";

/// 1, 2 or 5 times a power of ten: marks at this distance number at most `most` + 1 on an axis of that length, above 0.
double tick_step(double span, int most);

/// gnuplot: marks of the axis ("x" or "y") at that distance, at most `most` + 1 between these ends, with as many
/// decimals as the step: "−0.5", "0.0", and no powers of ten. The ends differ.
std::string even_tics(std::string_view axis, double from, double to, int most);

/// The label of a mark: four digits, "5·10⁻⁶" and "10⁻⁶" below 0.0001, with minus signs.
std::string tic_label(double value);

/// gnuplot: the axis' marks at these positions, with such labels.
std::string labelled_tics(std::string_view axis, const std::vector<double>& at);

/// 1, 2 and 5 times powers of ten, from the largest that is not above `from` to the smallest that is not below `to`,
/// both above 0.
std::vector<double> ladder_of(double from, double to);

/// The unit of a plot of small lengths, and the number of units per metre: µm if no length reaches 0.2 mm, otherwise
/// mm.
struct SmallLengthUnit {
  const char* name;
  double per_m;
};
SmallLengthUnit small_length_unit(double largest_m);

/// The x axis of values that were run, with some room at both ends and for items next to a value.
class ValueAxis {
 public:
  /// At least one value; if the axis is logarithmic, all are above 0.
  ValueAxis(std::vector<double> values, bool logarithmic);
  /// gnuplot: range, scale, a mark at each value (if there are many, at round numbers), and as many labels as fit in a
  /// plot of `points` width, including those of the first and the last value.
  std::string script(double points) const;
  /// The position of item i of `count` items that belong to one value: side by side, and never as far as halfway to the
  /// next value.
  double beside(double value, std::size_t i, std::size_t count) const;
  /// The number of different values.
  std::size_t size() const { return values_.size(); }

 private:
  double to_axis(double value) const;
  double from_axis(double place) const;
  std::vector<double> marks() const;
  std::vector<double> values_;  ///< sorted, each once
  bool logarithmic_;
  double from_ = 0.0, to_ = 1.0;  ///< in the coordinates of to_axis()
  double least_gap_ = 1.0;        ///< between two values, likewise
};

/// Indices (rising) of about `most` points that keep the outline of a line through all of them: the first, the last,
/// and the lowest and highest of each of most/2 equal parts. All of them if there are no more than `most`, or than
/// four. The drawing must look the same, and the page must stay small.
std::vector<std::size_t> outline(std::span<const double> y, std::size_t most);

/// Indices of `most` equally spaced points, including the first and the last (for 1 only the first), or of all if there
/// are no more: for clouds of points.
std::vector<std::size_t> every_nth(std::size_t count, std::size_t most);

}  // namespace glidelab::report
