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

/// A logarithmic axis: its values and some room, labelled at 1, 2 and 5 times powers of ten.
struct LogAxis {
  double from = std::numeric_limits<double>::infinity(), to = 0.0;
  void include(double value) {
    from = std::min(from, value);
    to = std::max(to, value);
  }
  double length() const { return std::log(to / from); }
  std::string script(const std::string& name) const {
    std::vector<double> tics = ladder_of(from, to);
    std::erase_if(tics, [this](double value) { return value < from || value > to; });
    return fmt::format("set {}range [{:.6g}:{:.6g}]\n", name, from, to) + labelled_tics(name, tics);
  }
};

/// `points`: cost, value, number. Points are close if a label would cover them: a fraction of the axes' length.
std::vector<Label> labels_of(const std::vector<std::vector<double>>& points, double wide, double high) {
  constexpr double kAcross = 0.07, kUp = 0.06;
  std::vector<Label> labels;
  for (const std::vector<double>& row : points) {
    const auto near = std::find_if(labels.begin(), labels.end(), [&](const Label& label) {
      return std::abs(std::log(row[0] / label.x)) < kAcross * wide && std::abs(std::log(row[1] / label.y)) < kUp * high;
    });
    Label& label = near == labels.end() ? labels.emplace_back(Label{row[0], row[1]}) : *near;
    label.right = std::max(label.right, row[0]);
    label.top = std::max(label.top, row[1]);
    label.numbers.push_back(static_cast<int>(row[2]));
  }
  // A label that would still cover a point of another takes that one's numbers in.
  const auto covers = [&](const Label& label, const std::vector<double>& row) {
    const double right = std::log(row[0] / label.right), up = std::log(row[1] / label.top);
    return right > 0.0 && right < kAcross * wide && up > -0.5 * kUp * high && up < kUp * high;
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
  std::string script = std::string(kFrame) + "set logscale xy\n";
  script +=
      fmt::format("set xlabel {}\nset ylabel {}\n",
                  gnuplot_quoted(requirement.by_price ? "price, middle of its class (EUR)" : "million pixels a second"),
                  gnuplot_quoted(target_name(target)));
  constexpr double kLeft = 1.2, kRight = 1.6, kAbove = 1.3;  // factors, for labels and bars
  LogAxis x, y;
  y.include(target.value / kAbove);
  y.include(target.value * kAbove);
  for (const std::vector<double>& row : all) {
    x.include(row[0] / kLeft);
    x.include(row[0] * kRight);
    y.include(row[3] / kAbove);
    y.include(row[4] * kAbove);
  }
  if (!all.empty()) script += x.script("x") + y.script("y");
  for (const Label& label : labels_of(all, x.length(), y.length())) {
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
  add(met, fmt::format("1:2:4:5 with yerrorbars pt 7 ps 0.8 lc rgb '{}' title 'reaches all targets'", kColors[2]));
  add(open,
      fmt::format("1:2:4:5 with yerrorbars pt 4 ps 0.8 lc rgb '{}' title 'not filmed, or too few runs'", kColors[0]));
  add(missed, fmt::format("1:2:4:5 with yerrorbars pt 6 ps 0.8 lc rgb '{}' title 'does not'", kColors[1]));
  return {Drawing{script, data, {620, 420}},
          "Error of each camera (numbered as in the tables) against its price, with one standard deviation where runs "
          "were made; the line joins those that no cheaper one beats",
          "Accuracy reached against cost"};
}

}  // namespace glidelab::report
