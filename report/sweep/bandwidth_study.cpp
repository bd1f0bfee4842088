#include "report/sweep/bandwidth_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/text/number_text.h"
#include "fit/estimators.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/sweep/sweep_meaning.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

using validate::ErrorStatistics;
using validate::Series;
using validate::SweepSummary;

constexpr std::size_t kLeastBandwidths = 3;

/// The bandwidth of the lines with a given one.
std::optional<double> given_bandwidth_s(const std::string& estimator) {
  const std::string start = std::string(fit::default_estimator().name) + " h=";
  if (!estimator.starts_with(start)) return std::nullopt;
  return std::strtod(estimator.c_str() + start.size(), nullptr);
}

/// Errors of one quantity by bandwidth.
using Curve = std::map<double, const ErrorStatistics*>;

const ErrorStatistics* overall(const SweepSummary& summary, std::string_view quantity, std::string_view estimator) {
  for (const Series& series : summary.overall) {
    if (series.quantity != quantity || series.estimator != estimator) continue;
    const ErrorStatistics& of = series.groups.front().statistics;
    return of.answered > 0 ? &of : nullptr;
  }
  return nullptr;
}

/// The curve over bandwidths for which nearly all runs have an answer; the others go to `unanswered`.
Curve curve_of(const SweepSummary& summary, std::string_view quantity, std::vector<double>& unanswered) {
  Curve curve;
  for (const Series& series : summary.overall) {
    const std::optional<double> h = given_bandwidth_s(series.estimator);
    if (series.quantity != quantity || !h) continue;
    const ErrorStatistics& of = series.groups.front().statistics;
    const bool answered =
        of.answered > 0 && static_cast<double>(of.answered) >= kLeastAnsweredShare * static_cast<double>(of.runs);
    if (answered) {
      curve[*h] = &of;
    } else if (std::find(unanswered.begin(), unanswered.end(), *h) == unanswered.end()) {
      unanswered.push_back(*h);
    }
  }
  return curve;
}

double least_total(const Curve& curve) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [h, of] : curve) least = std::min(least, of->rms);
  return least;
}

/// All quantities that have errors at enough bandwidths.
struct Curves {
  std::vector<std::pair<const QuantityName*, Curve>> of;
  std::vector<double> bandwidths_s;  ///< at which all quantities have errors, rising
  std::vector<double> unanswered_s;
};

Curves curves_of(const SweepSummary& summary) {
  Curves curves;
  for (const QuantityName& quantity : kQuantities) {
    Curve curve = curve_of(summary, quantity.key, curves.unanswered_s);
    if (curve.size() >= kLeastBandwidths && least_total(curve) > 0.0)
      curves.of.emplace_back(&quantity, std::move(curve));
  }
  std::sort(curves.unanswered_s.begin(), curves.unanswered_s.end());
  if (curves.of.empty()) return curves;
  for (const auto& [h, first] : curves.of.front().second) {
    const bool all = std::all_of(curves.of.begin(), curves.of.end(),
                                 [h = h](const auto& quantity) { return quantity.second.contains(h); });
    if (all) curves.bandwidths_s.push_back(h);
  }
  return curves;
}

/// The error at `h` over that at `other`, for the worst quantity.
double loss(const Curves& curves, double h, double other) {
  double most = 0.0;
  for (const auto& [quantity, curve] : curves.of) most = std::max(most, curve.at(h)->rms / curve.at(other)->rms);
  return most;
}

double loss_to_best(const Curves& curves, double h) {
  double most = 0.0;
  for (const auto& [quantity, curve] : curves.of) most = std::max(most, curve.at(h)->rms / least_total(curve));
  return most;
}

/// Three binomial standard errors, as everywhere on the page.
bool holds_too_seldom(const ErrorStatistics& of) {
  return of.sd > 0.0 && of.coverage < 0.95 - 3.0 * std::sqrt(0.95 * 0.05 / static_cast<double>(of.answered));
}

bool too_wide(const ErrorStatistics& of) {
  return of.coverage > 0.95 && of.sd > kTooWide * of.rms;
}

std::string seconds_text(double h) {
  return base::number_text(h, 3) + " s";
}

/// "from 0.1 s on", "up to 0.02 s", "at all bandwidths", or the values.
std::string where_text(const std::vector<double>& at, const std::vector<double>& all) {
  if (at.size() == all.size()) return "at every bandwidth";
  if (std::equal(at.begin(), at.end(), all.begin())) {
    return at.size() == 1 ? "at " + seconds_text(at.front()) : "up to " + seconds_text(at.back());
  }
  if (std::equal(at.rbegin(), at.rend(), all.rbegin())) {
    return "beyond " + seconds_text(all[all.size() - at.size() - 1]);
  }
  std::string text;
  for (const double h : at) text += (text.empty() ? "at " : ", ") + base::number_text(h, 3);
  return text + " s";
}

/// "the default rule chooses 0.05 s (0.04 to 0.06) and has errors up to 1.2 times as large".
std::string rule_words(const SweepSummary& summary, const Curves& curves, double use) {
  const std::string lines(fit::default_estimator().name);
  const auto chosen = std::find_if(summary.bandwidths.begin(), summary.bandwidths.end(),
                                   [&](const validate::ChosenBandwidth& of) { return of.estimator == lines; });
  double factor = 0.0;
  for (const auto& [quantity, curve] : curves.of) {
    const ErrorStatistics* const ours = overall(summary, quantity->key, lines);
    if (ours == nullptr) return {};
    factor = std::max(factor, ours->rms / curve.at(use)->rms);
  }
  if (chosen == summary.bandwidths.end()) return {};
  const std::string errors = factor > 1.05
                                 ? fmt::format("has errors up to {} times as large", base::number_text(factor, 2))
                                 : "has errors no larger";
  const std::string low = base::number_text(chosen->low_s, 2), high = base::number_text(chosen->high_s, 2);
  return fmt::format("; the default rule chooses {}{} and {}", seconds_text(chosen->median_s),
                     low == high ? "" : fmt::format(" ({} to {} in eight of ten clips)", low, high), errors);
}

/// An estimator without a bandwidth. First, where all its errors are smaller: "Use `--estimator trajectory`: it needs
/// no bandwidth and errs 4 to 8 times less. "; else last: "; the fit of …, which needs no bandwidth, has an error …".
struct FitWords {
  std::string first, last;
};

FitWords fit_words(const SweepSummary& summary, const Curves& curves, double use) {
  FitWords words;
  for (const fit::Estimator& other : fit::judged_estimators()) {
    if (other.of_lines) continue;
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (const auto& [quantity, curve] : curves.of) {
      const ErrorStatistics* const of = overall(summary, quantity->key, other.name);
      if (of == nullptr || !(of->rms > 0.0)) continue;
      least = std::min(least, curve.at(use)->rms / of->rms);
      most = std::max(most, curve.at(use)->rms / of->rms);
    }
    if (most == 0.0 || (least < 1.1 && most < 1.1)) continue;
    const std::string from = base::number_text(least, 2), to = base::number_text(most, 2);
    const std::string times = from == to ? from : from + " to " + to;
    if (least >= 1.1 && words.first.empty()) {
      words.first =
          fmt::format("Use `--estimator {}`: the {} needs no bandwidth, and its errors are {} times smaller. ",
                      other.name, other.title, times);
    } else {
      words.last +=
          fmt::format("; the {}, which needs no bandwidth, has an error {} times smaller", other.title, times);
    }
  }
  return words;
}

}  // namespace

std::optional<BandwidthAnswer> bandwidth_answer(const SweepSummary& summary) {
  const Curves curves = curves_of(summary);
  const std::vector<double>& all = curves.bandwidths_s;
  if (all.size() < kLeastBandwidths) return std::nullopt;
  BandwidthAnswer answer;
  answer.unanswered_s = curves.unanswered_s;
  for (const double h : all) {
    const auto any = [&](bool (*wrong)(const ErrorStatistics&)) {
      return std::any_of(curves.of.begin(), curves.of.end(),
                         [&](const auto& quantity) { return wrong(*quantity.second.at(h)); });
    };
    if (any(holds_too_seldom)) answer.narrow_s.push_back(h);
    if (any(too_wide)) answer.wide_s.push_back(h);
  }
  const auto wrong = [&](double h) {
    return std::find(answer.narrow_s.begin(), answer.narrow_s.end(), h) != answer.narrow_s.end() ||
           std::find(answer.wide_s.begin(), answer.wide_s.end(), h) != answer.wide_s.end();
  };
  const bool any_right = !std::all_of(all.begin(), all.end(), wrong);
  const auto best = std::min_element(all.begin(), all.end(), [&](double a, double b) {
    return std::pair(any_right && wrong(a), loss_to_best(curves, a)) <
           std::pair(any_right && wrong(b), loss_to_best(curves, b));
  });
  answer.use_s = *best;
  auto from = best, to = best;
  while (from != all.begin() && loss(curves, *(from - 1), answer.use_s) <= kNearlyAsGood) --from;
  while (to + 1 != all.end() && loss(curves, *(to + 1), answer.use_s) <= kNearlyAsGood) ++to;
  answer.from_s = *from;
  answer.to_s = *to;
  const FitWords fit = fit_words(summary, curves, answer.use_s);
  answer.text =
      fmt::format("{} h = {}", fit.first.empty() ? "Use" : fit.first + "For lines, use", seconds_text(answer.use_s));
  answer.text +=
      answer.from_s < answer.to_s
          ? fmt::format("; anything from {} to {} gives errors at most {:.0f} % larger", base::number_text(*from, 3),
                        seconds_text(*to), 100.0 * (kNearlyAsGood - 1.0))
          : fmt::format("; its neighbours give errors more than {:.0f} % larger", 100.0 * (kNearlyAsGood - 1.0));
  if (!answer.narrow_s.empty()) {
    answer.text += fmt::format("; {} the stated intervals are too narrow", where_text(answer.narrow_s, all));
  }
  if (!answer.wide_s.empty()) {
    answer.text += fmt::format("; {} the stated intervals are too wide", where_text(answer.wide_s, all));
  }
  if (!answer.unanswered_s.empty()) {
    std::vector<std::string> values;
    for (const double h : answer.unanswered_s) values.push_back(base::number_text(h, 3));
    answer.text += fmt::format("; with {} s some clips have no line", list_of(values));
  }
  answer.text += rule_words(summary, curves, answer.use_s) + fit.last + ".";
  return answer;
}

namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double positive(double value) {
  return value > 0.0 ? value : kNothing;
}

/// A horizontal line over the whole axis.
PlotData level(const std::string& name, double value, double from, double to) {
  return {name, {{from, value}, {to, value}}, {"h (s)", "error"}};
}

/// A range that begins and ends at 1, 2 or 5 times a power of ten, with no more than about nine of these labelled.
std::string error_range(const std::vector<PlotData>& data) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const PlotData& block : data) {
    for (const std::vector<double>& row : block.rows) {
      for (std::size_t i = 1; i < std::min<std::size_t>(row.size(), 5); ++i) {
        if (!(row[i] > 0.0)) continue;
        least = std::min(least, row[i]);
        most = std::max(most, row[i]);
      }
    }
  }
  constexpr std::size_t kMost = 9;
  constexpr double kRoom = 1.05;
  std::vector<double> ladder = ladder_of(least / kRoom, most * kRoom);
  const double from = ladder.front(), to = ladder.back();
  if (ladder.size() > kMost) {
    std::erase_if(ladder, [](double value) { return std::abs(std::remainder(std::log10(value), 1.0)) > 1e-6; });
  }
  return fmt::format("set yrange [{:.6g}:{:.6g}]\n", from, to) + labelled_tics("y", ladder);
}

Plot plot_of(const SweepSummary& summary, const QuantityName& quantity, const Curve& curve) {
  PlotData errors{"errors", {}, {"h (s)", "total", "noise", "|bias|", "stated sd", "|bias| above its noise"}};
  PlotData best{"best", {}, {"h (s)", "total"}};
  double bound = 0.0;
  std::vector<double> bandwidths_s;
  for (const auto& [h, of] : curve) {
    const double bias = std::abs(of->bias), noise = std::sqrt(std::max(0.0, of->rms * of->rms - bias * bias));
    errors.rows.push_back({h, positive(of->rms), positive(noise), positive(bias), positive(of->sd),
                           bias > 2.0 * of->bias_sd ? positive(bias) : kNothing});
    if (of->least_sd) bound = std::max(bound, *of->least_sd);
    bandwidths_s.push_back(h);
    if (of->rms == least_total(curve)) best.rows = {{h, of->rms}};
  }
  const std::string lines(fit::default_estimator().name);
  const ErrorStatistics* const rule = overall(summary, quantity.key, lines);
  const auto chosen = std::find_if(summary.bandwidths.begin(), summary.bandwidths.end(),
                                   [&](const validate::ChosenBandwidth& of) { return of.estimator == lines; });
  PlotData choice{"choice", {}, {"h (s)", "total", "h of 10 % of the clips (s)", "h of 90 % (s)"}};
  std::vector<double> ends = bandwidths_s;
  if (rule != nullptr && chosen != summary.bandwidths.end()) {
    choice.rows = {{chosen->median_s, positive(rule->rms)}};
    ends.insert(ends.end(), {chosen->low_s, chosen->high_s});
  }
  const auto [least, most] = std::minmax_element(ends.begin(), ends.end());
  const double from = *least / 1.15, to = *most * 1.15;
  std::vector<PlotData> data = {errors, best};
  std::string script =
      std::string(kFrame) +
      "set key at screen 0.5, screen 0.99 center top font ',11' vertical maxrows 4 width -2 samplen 1.6\n"
      "set tmargin at screen 0.76\nset logscale xy\nset offsets 0,0,0,0\n"
      "set xlabel 'bandwidth h (s)'\n" +
      fmt::format("set ylabel {}\nset xrange [{:.6g}:{:.6g}]\n",
                  gnuplot_quoted(with_unit("error of " + symbol_of(quantity.key), quantity.unit)), from, to) +
      labelled_tics("x", bandwidths_s);
  std::string drawn = fmt::format(
      "plot $errors using 1:2 with linespoints pt 7 ps 0.5 lw 2.2 lc rgb '{0}' title 'total', "
      "$errors using 1:3 with lines lw 1.4 dt 2 lc rgb '{1}' title 'noise', "
      "$errors using 1:4 with lines lw 1.4 lc rgb '{2}' title 'bias', "
      "$errors using 1:6 with points pt 7 ps 0.45 lc rgb '{2}' notitle, "
      "$errors using 1:5 with lines lw 1.2 dt 3 lc rgb '{3}' title 'stated sd', "
      "$best using 1:2 with points pt 6 ps 1.3 lw 1.6 lc rgb '{0}' title 'best h'",
      color(6), color(0), color(1), kThinGrey);
  if (!choice.rows.empty()) {
    choice.rows.front().insert(choice.rows.front().end(), {chosen->low_s, chosen->high_s});
    drawn += fmt::format(", $choice using 1:2:3:4 with xerrorbars pt 9 ps 1 lw 1.6 lc rgb '{}' title 'default rule'",
                         color(2));
    script += fmt::format("set arrow from {0:.6g}, graph 0 to {0:.6g}, graph 1 nohead dt 3 lw 0.8 lc rgb '{1}'\n",
                          chosen->median_s, color(2));
  }
  for (const fit::Estimator& other : fit::judged_estimators()) {
    const ErrorStatistics* const of = other.of_lines ? nullptr : overall(summary, quantity.key, other.name);
    if (of == nullptr || !(of->rms > 0.0)) continue;
    data.push_back(level("fit", of->rms, from, to));
    drawn += fmt::format(", $fit using 1:2 with lines lw 1.6 lc rgb '{}' title {}", color(3),
                         gnuplot_quoted(std::string(other.title)));
  }
  if (bound > 0.0) {
    data.push_back(level("bound", bound, from, to));
    drawn += fmt::format(", $bound using 1:2 with lines lw 1.2 dt 4 lc rgb '{}' title 'limit of one configuration'",
                         color(6));
  }
  script += error_range(data);
  if (!choice.rows.empty()) data.push_back(choice);
  return {Drawing{script + drawn, data, {480, 400}},
          fmt::format("Error of {} against the bandwidth. Total² is noise² + bias²; a dot on its line marks a bias of "
                      "more than two standard errors{}",
                      symbol_of(quantity.key),
                      bound > 0.0 ? ". The limit is that of clips of one configuration; the fit of the whole motion "
                                    "uses all together and may have smaller errors"
                                  : ""),
          fmt::format("Error of {} against the bandwidth", symbol_of(quantity.key))};
}

}  // namespace

std::vector<Plot> bandwidth_plots(const SweepSummary& summary) {
  const Curves curves = curves_of(summary);
  std::vector<Plot> plots;
  if (curves.bandwidths_s.size() < kLeastBandwidths) return plots;
  for (const auto& [quantity, curve] : curves.of) plots.push_back(plot_of(summary, *quantity, curve));
  return plots;
}

namespace {

/// A row of the table: what was run, and its statistics for each quantity; nullptr where it has none.
struct StudyRow {
  std::string page_name, typed_name;  ///< for people, and as one types it
  std::vector<const ErrorStatistics*> of;
};

std::vector<StudyRow> study_rows(const SweepSummary& summary, const Curves& curves) {
  std::vector<StudyRow> rows;
  std::set<double> bandwidths_s;  // of any quantity: one that few runs determine there is a dash
  for (const auto& [quantity, curve] : curves.of) {
    for (const auto& [h, of] : curve) bandwidths_s.insert(h);
  }
  for (const double h : bandwidths_s) {
    const std::string name = base::number_text(h, 3);
    StudyRow& row = rows.emplace_back(StudyRow{name, name, {}});
    for (const auto& [quantity, curve] : curves.of) {
      const auto found = curve.find(h);
      row.of.push_back(found == curve.end() ? nullptr : found->second);
    }
  }
  const auto add_estimator = [&](const std::string& page_name, const std::string& typed, std::string_view estimator) {
    StudyRow& row = rows.emplace_back(StudyRow{page_name, typed, {}});
    for (const auto& [quantity, curve] : curves.of) row.of.push_back(overall(summary, quantity->key, estimator));
  };
  add_estimator("default rule", "default rule", fit::default_estimator().name);
  for (const fit::Estimator& other : fit::judged_estimators()) {
    if (!other.of_lines) add_estimator(std::string(other.title), std::string(other.name), other.name);
  }
  return rows;
}

/// The largest relative standard error of an error, in words.
std::string known_to_words(const std::vector<StudyRow>& rows) {
  double known_to = 0.0;
  for (const StudyRow& row : rows) {
    for (const ErrorStatistics* of : row.of) {
      if (of != nullptr) known_to = std::max(known_to, 1.0 / std::sqrt(2.0 * static_cast<double>(of->answered)));
    }
  }
  return fmt::format("Root mean square errors, known to {:.0f} % or better (one standard error, if errors are normal)",
                     100.0 * known_to);
}

}  // namespace

std::string bandwidth_table(const SweepSummary& summary) {
  const Curves curves = curves_of(summary);
  if (curves.bandwidths_s.size() < kLeastBandwidths) return {};
  std::vector<std::string> header = {"bandwidth h (s)"};
  for (const auto& [quantity, curve] : curves.of) {
    header.insert(header.end(), {"error of " + escape(with_unit(quantity->symbol, quantity->unit)), "coverage"});
  }
  HtmlTable table(header, 1);
  const std::vector<StudyRow> rows = study_rows(summary, curves);
  for (const StudyRow& row : rows) {
    std::vector<std::string> cells = {row.page_name};
    for (const ErrorStatistics* of : row.of) {
      cells.push_back(of == nullptr ? "–" : base::digits_text(of->rms, 3));
      cells.push_back(of == nullptr ? "–" : fmt::format("{:.1f} %", 100.0 * of->coverage));
    }
    table.row(cells);
  }
  return table.str() + fmt::format(
                           "<p class=\"soft\">{}; coverage is the fraction of the stated 95 % intervals that contain "
                           "the true value.</p>\n",
                           known_to_words(rows));
}

std::string bandwidth_text(const SweepSummary& summary) {
  const Curves curves = curves_of(summary);
  if (curves.bandwidths_s.size() < kLeastBandwidths) return {};
  std::vector<std::vector<std::string>> table = {{"h (s)"}};
  for (const auto& [quantity, curve] : curves.of) {
    table.front().push_back(with_unit(quantity->symbol, quantity->unit));
  }
  const std::vector<StudyRow> rows = study_rows(summary, curves);
  for (const StudyRow& row : rows) {
    table.push_back({row.typed_name});
    for (const ErrorStatistics* of : row.of)
      table.back().push_back(of == nullptr ? "–" : base::digits_text(of->rms, 3));
  }
  return text_table(table, 1) + known_to_words(rows) + ".\n";
}

}  // namespace glidelab::report
