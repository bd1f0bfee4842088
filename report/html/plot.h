/// A plot before it is drawn: columns of numbers and the commands of gnuplot that draw them, the colours and the frame
/// that all plots share, axes whose labels do not run into each other, and which points of a long series a plot needs.
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

/// Columns of numbers under the name that the script calls them by: `plot $name using 1:2`. NaN breaks a line.
struct PlotData {
  std::string name;
  std::vector<std::vector<double>> rows;  ///< an empty row stands for a blank line, which breaks a line as well
  std::vector<std::string> columns = {};  ///< what each holds, with its unit: "v (m/s)"; for who reads the file
};

/// gnuplot takes a block without rows for an error; one row of NaN, as wide as `columns`, draws nothing.
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

/// A plot as it stands on a page, with a text for who cannot see it.
struct Plot {
  Drawing drawing;
  std::string caption;      ///< HTML-free text under the plot
  std::string description;  ///< for the alt attribute; the plot's files are named after it
};

/// Colours that colour-blind readers can tell apart, also in grey print; Okabe and Ito, "Color universal design"
/// (2008), without the yellow that white paper swallows.
inline constexpr std::array<std::string_view, 7> kColors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                            "#56b4e9", "#e69f00", "#000000"};
/// What stands behind the data or is left out; the ground of such a stretch.
inline constexpr std::string_view kGrey = "#9a9a9a";
inline constexpr std::string_view kShade = "#ececec";

/// Of the n-th series; they come again after the last.
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
    "set pointintervalbox 0.01\n"  // 0 is 1: gnuplot clears a disc of that size below a point with bars, and bars in it
    "set offsets graph 0.02, graph 0.02, graph 0.06, graph 0.06\n";

/// 1, 2 or 5 times a power of ten: marks that far apart are `most` + 1 at most on an axis of that length, above 0.
double tick_step(double span, int most);

/// gnuplot: marks of the axis ("x" or "y") that far apart, `most` + 1 at most over these ends, with as many decimals as
/// the step has: "−0.5", "0.0", and no powers of ten. The ends differ.
std::string even_tics(std::string_view axis, double from, double to, int most);

/// As a mark is labelled: four digits, "5·10⁻⁶" and "10⁻⁶" below 0.0001, with minus signs.
std::string tic_label(double value);

/// gnuplot: the axis' marks at these places, so labelled.
std::string labelled_tics(std::string_view axis, const std::vector<double>& at);

/// 1, 2 and 5 times powers of ten from the first that is not above `from` to the first that is not below `to`, both
/// above 0.
std::vector<double> ladder_of(double from, double to);

/// The unit of a plot of small lengths, and how many of it are a metre: µm where none is as long as 0.2 mm, else mm.
struct SmallLengthUnit {
  const char* name;
  double per_m;
};
SmallLengthUnit small_length_unit(double largest_m);

/// The x axis of values that were run, with some room at both ends and for what stands beside a value.
class ValueAxis {
 public:
  /// At least one value; where it is logarithmic all are above 0.
  ValueAxis(std::vector<double> values, bool logarithmic);
  /// gnuplot: range, scale, a mark at each value (of many at round numbers), and as many labels as a plot of `points`
  /// width has room for, the first and the last value's among them.
  std::string script(double points) const;
  /// Where number i of `count` things that belong to one value stands: side by side, and never as far as halfway to the
  /// next value.
  double beside(double value, std::size_t i, std::size_t count) const;
  /// How many different values there are.
  std::size_t size() const { return values_.size(); }

 private:
  double to_axis(double value) const;
  double from_axis(double place) const;
  std::vector<double> marks() const;
  std::vector<double> values_;  ///< sorted, each once
  bool logarithmic_;
  double from_ = 0.0, to_ = 1.0;  ///< as to_axis() gives them
  double least_gap_ = 1.0;        ///< of two values, likewise
};

/// Indices (rising) of about `most` points that keep the outline of a line through all of them: the first, the last,
/// and the lowest and highest of each of most/2 equal parts. All of them where there are no more than `most`, or than
/// four. What is drawn must look the same, and a page must stay small.
std::vector<std::size_t> outline(std::span<const double> y, std::size_t most);

/// Indices of `most` points at equal distance, the first and the last among them (of 1 the first alone), or of all
/// where there are no more: for clouds of points.
std::vector<std::size_t> every_nth(std::size_t count, std::size_t most);

}  // namespace glidelab::report
