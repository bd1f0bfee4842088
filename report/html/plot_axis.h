/// An axis of numbers whose labels do not run into each other.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::report {

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

}  // namespace glidelab::report
