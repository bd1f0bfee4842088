#include "report/requirement/requirement_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "report/html/gnuplot.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"

namespace glidelab::report {

using validate::Candidate;
using validate::Requirement;
using validate::Target;
using validate::Verdict;

bool reached(const Candidate& candidate) {
  return candidate.verdict == Verdict::reached || candidate.verdict == Verdict::by_bound;
}

std::string target_name(const Target& target, const std::string& factor) {
  std::string unit = unit_of(target.quantity);
  if (!factor.empty()) unit = factor + (unit.empty() ? "" : " " + unit);
  const char* measure = target.measure == Target::Measure::sd        ? "rms error"
                        : target.measure == Target::Measure::error95 ? "95 % error"
                                                                     : "bias";
  return with_unit(fmt::format("{} of {}", measure, symbol_of(target.quantity)), unit);
}

namespace {

double cost_of(const Requirement& requirement, const Candidate& candidate) {
  return requirement.by_price ? *candidate.price : candidate.pixels_s * 1e-6;
}

/// The quantity of the plot and the front: the first target, from runs if there are any, otherwise from its bound.
struct Reach {
  double value = std::numeric_limits<double>::quiet_NaN(), sd = 0.0;
};
Reach reach_of(const Candidate& candidate) {
  if (candidate.verdict == Verdict::refused || candidate.results.empty()) return {};
  const validate::TargetResult& result = candidate.results.front();
  Reach reach;
  if (result.found) {
    reach.value = *result.found;
    reach.sd = result.found_sd;
  } else if (result.bound) {
    reach.value = *result.bound;
  }
  return std::isfinite(reach.value) && reach.value > 0.0 ? reach : Reach{};
}

/// A label of one point, or of several close together.
struct Label {
  double x = 0.0, y = 0.0;
  std::vector<int> numbers = {};
  double right = 0.0, top = 0.0;  ///< extent of the points: beyond it the label covers none
};

/// An axis for values of several powers of ten: their logarithm, or, where one of them is 0 (a camera at hand costs
/// nothing), log(1 + value/unit) with the least other one as its unit. Labelled at 1, 2 and 5 times powers of ten.
struct PowerAxis {
  double from = std::numeric_limits<double>::infinity(), to = 0.0;
  double unit = 0.0;  ///< 0: the logarithm alone
  void include(double value) {
    from = std::min(from, value);
    to = std::max(to, value);
  }
  double place(double value) const { return std::log(unit > 0.0 ? 1.0 + value / unit : value); }
  double value_at(double place) const { return unit > 0.0 ? unit * (std::exp(place) - 1.0) : std::exp(place); }
  /// How much farther up the axis the first value is.
  double between(double value, double other) const { return place(value) - place(other); }
  double length() const { return between(to, from); }
  std::string script(const std::string& name) const {
    std::vector<double> tics = ladder_of(unit > 0.0 ? unit : from, to);
    if (unit > 0.0) tics.insert(tics.begin(), 0.0);
    std::erase_if(tics, [this](double value) { return value < from || value > to; });
    const std::string scale =
        unit > 0.0
            ? fmt::format("set nonlinear {0} via log(1.0+{0}/{1:.6g}) inverse {1:.6g}*(exp({0})-1.0)\n", name, unit)
            : fmt::format("set logscale {}\n", name);
    return scale + fmt::format("set {}range [{:.6g}:{:.6g}]\n", name, from, to) + labelled_tics(name, tics);
  }
};

/// Of the costs, or 1 if all are 0.
double least_above_zero(const std::vector<std::vector<double>>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& row : points) {
    if (row[0] > 0.0) least = std::min(least, row[0]);
  }
  return std::isfinite(least) ? least : 1.0;
}

/// `points`: cost, value, number. Points are close if a label would cover them: a fraction of the axes' length.
std::vector<Label> labels_of(const std::vector<std::vector<double>>& points, const PowerAxis& x, const PowerAxis& y) {
  const double across = 0.07 * x.length(), up = 0.06 * y.length();
  std::vector<Label> labels;
  for (const std::vector<double>& row : points) {
    const auto near = std::find_if(labels.begin(), labels.end(), [&](const Label& label) {
      return std::abs(x.between(row[0], label.x)) < across && std::abs(y.between(row[1], label.y)) < up;
    });
    Label& label = near == labels.end() ? labels.emplace_back(Label{row[0], row[1]}) : *near;
    label.right = std::max(label.right, row[0]);
    label.top = std::max(label.top, row[1]);
    label.numbers.push_back(static_cast<int>(row[2]));
  }
  // A label that would still cover a point of another takes that one's numbers in.
  const auto covers = [&](const Label& label, const std::vector<double>& row) {
    const double right = x.between(row[0], label.right), above = y.between(row[1], label.top);
    return right > 0.0 && right < across && above > -0.5 * up && above < up;
  };
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (std::size_t k = 0; k < labels.size(); ++k) {
      const bool hides =
          i != k && std::ranges::any_of(points, [&](const std::vector<double>& row) {
            return std::ranges::count(labels[k].numbers, static_cast<int>(row[2])) > 0 && covers(labels[i], row);
          });
      if (!hides) continue;
      labels[i].right = std::max(labels[i].right, labels[k].right);
      labels[i].top = std::max(labels[i].top, labels[k].top);
      labels[i].numbers.insert(labels[i].numbers.end(), labels[k].numbers.begin(), labels[k].numbers.end());
      std::ranges::sort(labels[i].numbers);
      labels.erase(labels.begin() + static_cast<std::ptrdiff_t>(k));
      i = k = 0;
    }
  }
  return labels;
}

}  // namespace

std::string ranges_text(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", numbers[i]);
    if (last > i) text += fmt::format("{}{}", last > i + 1 ? "-" : ", ", numbers[last]);
    i = last + 1;
  }
  return text;
}

Plot requirement_plot(const Requirement& requirement) {
  const Target& target = requirement.targets.front();
  PlotData met{"met", {}}, open{"open", {}}, missed{"missed", {}}, front{"front", {}};
  double best = std::numeric_limits<double>::infinity();
  double number = 0.0;
  std::vector<std::vector<double>> all;
  for (const Candidate& candidate : requirement.candidates) {  // the cheapest first
    ++number;
    const Reach reach = reach_of(candidate);
    const double cost = cost_of(requirement, candidate);
    if (!std::isfinite(reach.value)) continue;
    // On a logarithmic axis one standard deviation is drawn equally long upwards and downwards.
    const double times = std::exp(reach.sd / reach.value);
    all.push_back({cost, reach.value, number, reach.value / times, reach.value * times});
    const bool is_open = candidate.verdict == Verdict::unconfirmed || candidate.verdict == Verdict::undecided;
    (reached(candidate) ? met : is_open ? open : missed).rows.push_back(all.back());
    if (reach.value < best) {
      if (!front.rows.empty()) front.rows.push_back({cost, best});
      front.rows.push_back({cost, reach.value});
      best = reach.value;
    }
  }
  std::vector<PlotData> data;
  std::string script(kFrame);
  script +=
      fmt::format("set xlabel {}\nset ylabel {}\n",
                  gnuplot_quoted(requirement.by_price ? "price, middle of its class (EUR)" : "million pixels a second"),
                  gnuplot_quoted(target_name(target)));
  constexpr double kAbove = 1.3;                 // a factor, for bars
  constexpr double kLeft = 0.05, kRight = 0.12;  // of the axis; at the right there are labels
  PowerAxis x, y;
  y.include(target.value / kAbove);
  y.include(target.value * kAbove);
  for (const std::vector<double>& row : all) {
    x.include(row[0]);
    y.include(row[3] / kAbove);
    y.include(row[4] * kAbove);
  }
  if (!all.empty()) {
    if (x.from <= 0.0) x.unit = least_above_zero(all);
    const double span = x.to > x.from ? x.length() : 1.0, left = x.place(x.from), right = x.place(x.to);
    x.from = x.value_at(left - kLeft * span);
    x.to = x.value_at(right + kRight * span);
    script += x.script("x") + y.script("y");
  }
  for (const Label& label : labels_of(all, x, y)) {
    script += fmt::format("set label {} at {:.9g},{:.9g} front offset 0.8,0.45 font ',11'\n",
                          gnuplot_quoted(ranges_text(label.numbers)), label.right, label.top);
  }
  script +=
      fmt::format("set offsets 0,0,0,0\nplot {:.9g} with lines dt 2 lc rgb '#555555' title 'target'", target.value);
  const auto add = [&](const PlotData& block, const std::string& how) {
    if (block.rows.empty()) return;
    script += fmt::format(", ${} using {}", block.name, how);
    data.push_back(block);
  };
  add(front, fmt::format("1:2 with lines lw 1.5 lc rgb '{}' title 'Pareto front'", kColors[4]));
  add(met, fmt::format("1:2:4:5 with yerrorbars pt 7 ps 0.8 lc rgb '{}' title 'reaches all'", kColors[2]));
  add(open, fmt::format("1:2:4:5 with yerrorbars pt 4 ps 0.8 lc rgb '{}' title 'open'", kColors[0]));
  add(missed, fmt::format("1:2:4:5 with yerrorbars pt 6 ps 0.8 lc rgb '{}' title 'misses'", kColors[1]));
  return {Drawing{script, data, {620, 420}},
          "Error of each camera (numbered as in the tables) against its price, with one standard deviation where runs "
          "were made. Open: not filmed, or too few runs. The line joins those that no cheaper one beats",
          "Accuracy reached against cost"};
}

}  // namespace glidelab::report
