#include "report/validation/validation_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <vector>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "fit/estimators.h"
#include "report/analysis/camera_plots.h"
#include "report/analysis/sections.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"
#include "report/text/outside_text.h"
#include "report/text/why_words.h"

namespace glidelab::report {

std::string comparison_json(const validate::Comparison& comparison) {
  Json document;
  document["format"] = 1;
  document["quantities"] = Json::array();
  for (const validate::QuantityComparison& quantity : comparison.quantities) {
    Json object;
    object["configuration"] = quantity.configuration;
    object["mass_kg"] = quantity.mass_kg;
    object["incline_deg"] = quantity.incline_deg;
    object["estimator"] = quantity.estimator;
    object["quantity"] = quantity.quantity;
    put(object, "truth", quantity.truth, "the scenario does not have it");
    const std::string why = why_words(quantity.why);
    put(object, "value", quantity.value, why);
    put(object, "sd", quantity.sd, why);
    put(object, "error", quantity.error, quantity.truth ? why : "there is no truth to compare with");
    const char* const unbounded =
        "the motion does not determine it, or the law is not viscous drag with Coulomb friction";
    put(object, "cramer_rao_sd", quantity.cramer_rao_sd, unbounded);
    put(object, "noise_sd", quantity.noise_sd, why);
    put(object, "efficiency", quantity.efficiency, quantity.cramer_rao_sd ? why : unbounded);
    document["quantities"].push_back(std::move(object));
  }
  document["lines"] = Json::array();
  for (const validate::LineComparison& line : comparison.lines) {
    Json object{{"clip", line.clip}, {"direction", line.direction}};
    put(object, "r2", line.r2);
    document["lines"].push_back(std::move(object));
  }
  const validate::RestitutionComparison& restitution = comparison.restitution;
  const bool measured = !restitution.points.empty();
  Json& positions = document["restitution"];
  put(positions, "rms_m", measured ? std::optional(restitution.rms_m) : std::nullopt, "no marker was found");
  put(positions, "max_m", measured ? std::optional(restitution.max_m) : std::nullopt, "no marker was found");
  put(positions, "field_m", restitution.field_m);
  document["frames"] = comparison.frames;
  document["detected"] = comparison.detected;
  document["frames_out_of_view"] = comparison.frames_out_of_view;
  document["out_of_view"] = comparison.out_of_view;
  put(document, "wall_s", comparison.wall_s);
  if (comparison.outside) document["outside"] = outside_json(*comparison.outside);
  return json_text(document);
}

namespace {

constexpr std::size_t kRestitutionPoints = 2000;
constexpr std::size_t kMostNamed = kColors.size();  // clips that each have their own colour

/// One row per quantity, one colour per kind of quantity, filled for the lines' values and open for the whole motion's;
/// the reader looks for points beyond the band of ±2.
std::vector<Plot> error_plot(const validate::Comparison& comparison) {
  std::map<std::string, PlotData> by_quantity;
  std::vector<std::string> order;
  std::string tics;
  std::map<std::pair<std::string, std::string>, double> row_of;  // configuration and quantity
  std::map<std::string, int> marks;                              // gnuplot's point types, by the name of the data
  constexpr int kDisc = 7, kCircle = 6, kSquare = 4;
  double widest = 3.0;
  for (const validate::QuantityComparison& quantity : comparison.quantities) {
    if (!quantity.error || !quantity.sd || !(*quantity.sd > 0.0)) continue;
    const fit::Estimator* const estimator = fit::find_estimator(quantity.estimator);
    const int mark = estimator == nullptr ? kSquare : estimator->of_lines ? kDisc : kCircle;
    const std::string kind = fmt::format("{} {}", quantity.quantity, mark);
    if (!by_quantity.contains(kind)) {
      order.push_back(kind);
      by_quantity[kind].name = fmt::format("q{}", order.size());
      by_quantity[kind].columns = {fmt::format("error of {} / standard deviation", symbol_of(quantity.quantity)),
                                   "row"};
      marks[kind] = mark;
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
                          data.back().name, marks[order[n]], color(n % 4));
  }
  const int height = std::max(330, 80 + static_cast<int>(row_of.size()) * 22);
  return {{Drawing{script, data, {480, height}},
           "Error of each recovered value in units of its own standard deviation; about 95 % should lie within the "
           "band. Filled: lines of the phase diagram; open: fit of the whole motion" +
               (comparison.outside ? fmt::format("; squares: {}", comparison.outside->name) : std::string()),
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
  return {{Drawing{script, data},
           fmt::format("Error of the measured position along the track, one colour for each clip{}",
                       named ? "" : ", in turn"),
           "Restitution error against the true position"}};
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

namespace {

constexpr double kAgrees_sd = 2.0;  // standard deviations from the truth: 95 of 100 values lie within

/// The fit of the whole motion if it has a value, because it is more precise; otherwise the first of the estimators.
std::string headline_estimator(const validate::Comparison& comparison) {
  for (const validate::QuantityComparison& q : comparison.quantities) {
    const fit::Estimator* const estimator = fit::find_estimator(q.estimator);
    if (estimator != nullptr && !estimator->of_lines && q.value) return q.estimator;
  }
  return comparison.quantities.empty() ? std::string() : comparison.quantities.front().estimator;
}

std::string name_of(const validate::QuantityComparison& q) {
  return fmt::format("{} ({:.6g} kg, {:.4g}°)", q.configuration, q.mass_kg, q.incline_deg);
}

/// How many values are close to their truth, and which is farthest off; one sentence.
std::string agreement_of(const validate::Comparison& comparison) {
  std::size_t compared = 0, near = 0;
  double worst = 0.0;
  const validate::QuantityComparison* farthest = nullptr;
  for (const validate::QuantityComparison& q : comparison.quantities) {
    if (!q.error || !q.sd || !(*q.sd > 0.0)) continue;
    ++compared;
    const double in_sd = std::abs(*q.error) / *q.sd;
    if (in_sd <= kAgrees_sd) ++near;
    if (in_sd <= worst) continue;
    worst = in_sd;
    farthest = &q;
  }
  const std::string failed = comparison.outside ? outside_failed(*comparison.outside) : std::string();
  std::string text = failed.empty() ? failed : failed + " ";
  if (compared == 0) return text + "No recovered value could be compared with a true one.";
  text += fmt::format("{} of {} recovered values lie within two standard deviations of the truth", near, compared);
  if (farthest != nullptr) {
    text += fmt::format("; the largest error: {} of {} {}, {} standard deviations", symbol_of(farthest->quantity),
                        farthest->configuration, by_estimator(farthest->estimator), base::digits_text(worst, 2));
  }
  return text + ".";
}

/// A quantity that these motions do not have (a level track has no terminal velocity) gets no row.
bool is_absent(const validate::QuantityComparison& of) {
  return !of.truth && !of.value;
}

/// One value of each configuration for which the estimator has any, by falling mass.
std::vector<const validate::QuantityComparison*> recovered_configurations(const validate::Comparison& comparison,
                                                                          const std::string& estimator) {
  std::vector<const validate::QuantityComparison*> found;
  for (const validate::QuantityComparison& q : comparison.quantities) {
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const auto* other) { return other->configuration == q.configuration; });
    if (q.estimator == estimator && q.value && !known) found.push_back(&q);
  }
  std::stable_sort(found.begin(), found.end(), [](const auto* a, const auto* b) { return a->mass_kg > b->mass_kg; });
  return found;
}

/// The answer, and three or four numbers: those of the middle mass.
std::string headline(const validate::Comparison& comparison) {
  const std::string answer = base::printable_text(agreement_of(comparison));
  const std::string estimator = headline_estimator(comparison);
  const auto configurations = recovered_configurations(comparison, estimator);
  if (configurations.empty()) return answer + "\n";
  const validate::QuantityComparison& typical = *configurations[configurations.size() / 2];
  std::vector<std::vector<std::string>> rows = {{"quantity", "recovered", "truth"}};
  bool no_constant = false;
  for (const validate::QuantityComparison& q : comparison.quantities) {
    if (q.estimator != estimator || q.configuration != typical.configuration || is_absent(q)) continue;
    const double sd = q.sd.value_or(0.0);
    rows.push_back({heading_of(q.quantity), q.value ? base::value_and_sd_text(*q.value, sd) : "–",
                    q.truth ? base::value_text(*q.truth, sd) : "–"});
    no_constant = no_constant || (q.value && !q.truth);
  }
  const std::string among =
      configurations.size() == 1 ? "" : fmt::format(", one of {} configurations", configurations.size());
  return fmt::format("{}\n\nRecovered from the images with the {}, ± one sd:\n\n{}{}:\n{}{}", answer,
                     estimator_name(estimator), base::printable_text(name_of(typical)), among, text_table(rows, 1),
                     no_constant ? "A truth of \"–\": the friction law of this scenario has no such constant.\n" : "");
}

/// The errors of the measured positions, in one line.
std::string restitution_text(const validate::RestitutionComparison& restitution) {
  if (restitution.points.empty()) return "\nposition error: no marker was found\n";
  std::string text =
      fmt::format("\nposition error: {} mm rms, {} mm at most", base::number_text(restitution.rms_m * 1e3, 3),
                  base::number_text(restitution.max_m * 1e3, 3));
  if (restitution.field_m > 0.0) {
    text += fmt::format(" ({} % and {} % of the {} m that the motion covers)",
                        base::number_text(100.0 * restitution.rms_m / restitution.field_m, 2),
                        base::number_text(100.0 * restitution.max_m / restitution.field_m, 2),
                        base::number_text(restitution.field_m, 3));
  }
  return text + "\n";
}

std::string cell(const std::optional<double>& value, std::string (*text)(double, double), double sd) {
  return value ? text(*value, sd) : "–";
}

std::string comparison_table(const validate::Comparison& comparison) {
  HtmlTable table(
      {"quantity", "truth", "recovered", "sd", "error", "error / sd", "relative", "least sd", "efficiency"});
  table.stack_when_narrow(1);
  std::string previous, estimator;
  for (const validate::QuantityComparison& q : comparison.quantities) {
    if (is_absent(q)) continue;
    const double sd = q.sd.value_or(0.0);
    if (q.configuration != previous || q.estimator != estimator) {
      table.heading(fmt::format("{}: {:.6g} kg, stated {:.4g}°, {}", escape(q.configuration), q.mass_kg, q.incline_deg,
                                escape(estimator_name(q.estimator))));
    }
    previous = q.configuration;
    estimator = q.estimator;
    std::string in_sd = "–";
    if (q.error && sd > 0.0) {
      const double ratio = *q.error / sd;
      // Three standard deviations happen once in 370 times; a larger deviation deserves the reader's attention.
      in_sd = fmt::format("<span class=\"{}\">{:+.2f}</span>", std::abs(ratio) <= 3.0 ? "good" : "bad", ratio);
    }
    const bool relative = q.error && q.truth && *q.truth != 0.0 && q.quantity != core::key_of(core::Measurand::alpha) &&
                          q.quantity != core::key_of(core::Measurand::mu);
    table.row({escape(heading_of(q.quantity)), cell(q.truth, base::value_text, sd),
               q.value ? base::value_text(*q.value, sd)
                       : fmt::format("<span title=\"{}\">–</span>", escape(why_words(q.why))),
               q.sd ? base::sd_text(*q.sd) : "–", cell(q.error, base::error_text, sd), in_sd,
               relative ? fmt::format("{:+.3f} %", 100.0 * *q.error / *q.truth) : "–",
               q.cramer_rao_sd ? base::sd_text(*q.cramer_rao_sd) : "–",
               q.efficiency ? base::number_text(*q.efficiency, 2) : "–"});
  }
  return table.str();
}

}  // namespace

namespace {

/// The errors of each estimator in each configuration, as tables.
std::string errors_text(const validate::Comparison& comparison) {
  std::string text, name;
  std::vector<std::vector<std::string>> rows;
  const auto end_table = [&] {
    if (!rows.empty()) text += "\n" + base::printable_text(name) + "\n" + text_table(rows, 1);
    rows.clear();
  };
  for (const validate::QuantityComparison& q : comparison.quantities) {
    if (is_absent(q)) continue;
    const std::string of = fmt::format("{}, {}:", name_of(q), estimator_name(q.estimator));
    if (of != name || rows.empty()) {
      end_table();
      name = of;
      rows = {{"quantity", "truth", "recovered", "sd", "error", "error/sd"}};
    }
    const double sd = q.sd.value_or(0.0);
    rows.push_back({heading_of(q.quantity), q.truth ? base::value_text(*q.truth, sd) : "–",
                    q.value ? base::value_text(*q.value, sd) : "–", q.sd ? base::sd_text(*q.sd) : "–",
                    q.error ? base::error_text(*q.error, sd) : "–",
                    q.error && sd > 0.0 ? fmt::format("{:+.2f}", *q.error / sd) : "–"});
  }
  end_table();
  return text;
}

}  // namespace

std::string comparison_text(const validate::Comparison& comparison) {
  std::string text = headline(comparison) + "\nIn full:\n" + errors_text(comparison);
  std::string reasons;
  for (const validate::QuantityComparison& q : comparison.quantities) {
    if (!q.value && q.truth) {
      reasons += fmt::format("{}, {}: no {}: {}\n", q.configuration, q.estimator, symbol_of(q.quantity),
                             base::printable_text(why_words(q.why)));
    }
  }
  if (!reasons.empty()) text += fmt::format("\n{}", reasons);

  std::vector<std::vector<std::string>> rows = {{"clip", "line", "R²"}};
  for (const validate::LineComparison& line : comparison.lines) {
    rows.push_back({line.clip, line.direction < 0 ? "v < 0" : "v > 0", base::r2_text(line.r2)});
  }
  text += '\n';
  text += text_table(rows, 2);
  text += restitution_text(comparison.restitution);
  text += fmt::format("marker found in {} of {} frames\n", comparison.detected, comparison.frames);
  for (const std::string& sentence : comparison.out_of_view) text += base::printable_text(sentence) + "\n";
  text += fmt::format("time to render and analyse: {:.1f} s\n", comparison.wall_s);
  if (comparison.outside) text += outside_text(*comparison.outside) + "\n";
  return text;
}

std::string meaning_of(const validate::Comparison& comparison) {
  std::string text = "<p><b>" + escape(agreement_of(comparison)) + "</b></p>\n";
  const validate::RestitutionComparison& restitution = comparison.restitution;
  if (!restitution.points.empty() && restitution.field_m > 0.0) {
    text += fmt::format(
        "<p>The marker was found in {} of {} frames; its measured position is off by {} mm (rms), at most {} mm, which "
        "is {} % and {} % of the {} m that the motion covers.</p>\n",
        comparison.detected, comparison.frames, base::number_text(restitution.rms_m * 1e3, 2),
        base::number_text(restitution.max_m * 1e3, 2),
        base::number_text(100.0 * restitution.rms_m / restitution.field_m, 2),
        base::number_text(100.0 * restitution.max_m / restitution.field_m, 2),
        base::number_text(restitution.field_m, 3));
  }
  for (const std::string& sentence : comparison.out_of_view) {
    text += fmt::format("<p class=\"note\">{}.</p>\n", escape(sentence));
  }
  return meaning_section(text);
}

Page validation_report(const std::string& title, const core::AnalysisResults& results,
                       const validate::Comparison& comparison, const std::vector<core::Preview>& previews,
                       const base::Progress& progress) {
  double lowest_r2 = 1.0;
  for (const validate::LineComparison& line : comparison.lines) lowest_r2 = std::min(lowest_r2, line.r2);
  const validate::RestitutionComparison& restitution = comparison.restitution;
  Html body = question_heading(title, "How well are the true values recovered?") + meaning_of(comparison);
  body +=
      "<p class=\"soft\">A rehearsal: simulated, filmed, analysed from the images alone with the lines of the phase "
      "diagram and with the fit of the whole motion, and compared with the truth.</p>\n";
  body += "<div class=\"tiles\">" +
          tile(fmt::format("{} / {}", comparison.detected, comparison.frames), "frames with the marker found") +
          (comparison.frames_out_of_view == 0
               ? std::string()
               : tile(std::to_string(comparison.frames_out_of_view), "frames lost: the marker is outside the image")) +
          tile(restitution.points.empty() ? "–" : base::number_text(restitution.rms_m * 1e3, 2) + " mm",
               "position error (rms)") +
          tile(comparison.lines.empty() ? "–" : base::r2_text(lowest_r2), "lowest R² of a line") +
          tile(fmt::format("{:.1f} s", comparison.wall_s), "to render and analyse") + "</div>\n";
  body += "<h2 id=\"comparison\">Truth and recovered values</h2>\n" + comparison_table(comparison);
  body +=
      "<p class=\"soft\">sd is the standard deviation that the analysis states, camera and scale included; least sd is "
      "the smallest that the position noise allows (Cramér-Rao bound); efficiency is (least sd / sd due to position "
      "noise)².</p>\n";
  if (comparison.outside) body += fmt::format("<p>{}.</p>\n", escape(outside_text(*comparison.outside)));
  body += figures(validation_plots(results, comparison));
  body += folded("Phase diagrams and recovered values", phase_section(results) + recovered_section(results));
  body += folded("Lines, camera, clips and method", details_sections(results, previews, progress));
  return page(title, body);
}

}  // namespace glidelab::report
