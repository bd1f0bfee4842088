#include "report/validation/validation_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/text/number_text.h"
#include "fit/estimators.h"
#include "report/analysis/sections.h"
#include "report/html/html.h"
#include "report/text/quantity_names.h"
#include "report/text/text_table.h"
#include "report/validation/validation_plots.h"

namespace glidelab::report {
namespace {

constexpr double kAgrees_sd = 2.0;  // standard deviations from the truth: 95 of 100 values lie within

/// What a reader wants to know first.
constexpr std::array<std::string_view, 3> kHeadline = {"k_over_m_1_s", "mu", "alpha_deg"};

/// The fit of the whole motion where it has a value, as it is the more precise; else the first of the estimators.
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

/// "2.768 ± 0.002 (2.7680)"; "–" where nothing was recovered or is true.
std::string beside_truth(const validate::QuantityComparison& q) {
  const double sd = q.sd.value_or(0.0);
  return fmt::format("{} ({})", q.value ? base::value_and_sd_text(*q.value, sd) : "–",
                     q.truth ? base::value_text(*q.truth, sd) : "–");
}

/// How many values lie near their truth, and which is farthest off; one sentence.
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
  if (compared == 0) return "No recovered value could be compared with a true one.";
  std::string text =
      fmt::format("{} of {} recovered values lie within two of their standard deviations of the truth", near, compared);
  if (farthest != nullptr) {
    text +=
        fmt::format("; the farthest off is {} of {} by the {}: {} standard deviations", symbol_of(farthest->quantity),
                    farthest->configuration, estimator_name(farthest->estimator), base::digits_text(worst, 2));
  }
  return text + ".";
}

std::string headline(const validate::Comparison& comparison) {
  const std::string estimator = headline_estimator(comparison);
  if (estimator.empty()) return agreement_of(comparison) + "\n";
  std::vector<std::vector<std::string>> rows = {{"configuration"}};
  std::vector<std::string> names;  // of the configurations, in their order
  for (const validate::QuantityComparison& q : comparison.quantities) {
    if (q.estimator != estimator || (!names.empty() && names.back() == q.configuration)) continue;
    names.push_back(q.configuration);
    rows.push_back({name_of(q)});
  }
  bool no_constant = false;
  for (const std::string_view key : kHeadline) {
    std::vector<std::string> column;
    bool any = false;
    for (const validate::QuantityComparison& q : comparison.quantities) {
      if (q.estimator != estimator || q.quantity != key) continue;
      column.push_back(beside_truth(q));
      any = any || q.value || q.truth;
      no_constant = no_constant || (q.value && !q.truth);
    }
    if (!any || column.size() != names.size()) continue;
    rows.front().push_back(heading_of(key));
    for (std::size_t i = 0; i < column.size(); ++i) rows[i + 1].push_back(column[i]);
  }
  return fmt::format(
      "Recovered from the images alone by the {}, ± one standard deviation, and in brackets the truth:\n\n{}\n{}{}\n",
      estimator_name(estimator), text_table(rows, 1),
      no_constant ? "A truth \"–\": the law of friction in this scenario has no such constant.\n" : "",
      printable(agreement_of(comparison)));
}

/// How far measured positions are off, in a line.
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
  std::string previous, estimator;
  for (const validate::QuantityComparison& q : comparison.quantities) {
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
      // Three standard deviations happen once in 370 times; a reader should look at more.
      in_sd = fmt::format("<span class=\"{}\">{:+.2f}</span>", std::abs(ratio) <= 3.0 ? "good" : "bad", ratio);
    }
    const bool relative = q.error && q.truth && *q.truth != 0.0 && q.quantity != "alpha_deg" && q.quantity != "mu";
    table.row({escape(heading_of(q.quantity)), cell(q.truth, base::value_text, sd),
               q.value ? base::value_text(*q.value, sd) : fmt::format("<span title=\"{}\">–</span>", escape(q.why)),
               q.sd ? base::sd_text(*q.sd) : "–", cell(q.error, base::error_text, sd), in_sd,
               relative ? fmt::format("{:+.3f} %", 100.0 * *q.error / *q.truth) : "–",
               q.cramer_rao_sd ? base::sd_text(*q.cramer_rao_sd) : "–",
               q.efficiency ? base::number_text(*q.efficiency, 2) : "–"});
  }
  return table.str();
}

}  // namespace

std::string comparison_text(const validate::Comparison& comparison) {
  std::vector<std::vector<std::string>> rows = {
      {"configuration", "estimator", "quantity", "truth", "recovered", "sd", "error", "error/sd", "least sd"}};
  std::string estimator;
  std::string previous;
  for (const validate::QuantityComparison& q : comparison.quantities) {
    const double sd = q.sd.value_or(0.0);
    const bool first = q.configuration != previous;
    const bool other = first || q.estimator != estimator;
    previous = q.configuration;
    estimator = q.estimator;
    rows.push_back({first ? fmt::format("{} ({:.6g} kg, {:.4g}°)", q.configuration, q.mass_kg, q.incline_deg) : "",
                    other ? q.estimator : "", heading_of(q.quantity), q.truth ? base::value_text(*q.truth, sd) : "–",
                    q.value ? base::value_text(*q.value, sd) : "–", q.sd ? base::sd_text(*q.sd) : "–",
                    q.error ? base::error_text(*q.error, sd) : "–",
                    q.error && sd > 0.0 ? fmt::format("{:+.2f}", *q.error / sd) : "–",
                    q.cramer_rao_sd ? base::sd_text(*q.cramer_rao_sd) : "–"});
  }
  std::string text = headline(comparison) + "\nIn full:\n" + text_table(rows, 3);
  std::string reasons;
  for (const validate::QuantityComparison& q : comparison.quantities) {
    if (!q.value && q.truth) {
      reasons +=
          fmt::format("{}, {}: no {}: {}\n", q.configuration, q.estimator, symbol_of(q.quantity), printable(q.why));
    }
  }
  if (!reasons.empty()) text += fmt::format("\n{}", reasons);

  rows = {{"clip", "line", "R²"}};
  for (const validate::LineComparison& line : comparison.lines) {
    rows.push_back({line.clip, line.direction < 0 ? "v < 0" : "v > 0", base::r2_text(line.r2)});
  }
  text += '\n';
  text += text_table(rows, 2);
  text += restitution_text(comparison.restitution);
  text += fmt::format("marker found in {} of {} frames\ntime to render and analyse: {:.1f} s\n", comparison.detected,
                      comparison.frames, comparison.wall_s);
  return text;
}

std::string meaning_of(const validate::Comparison& comparison) {
  std::string text = "<p>" + escape(agreement_of(comparison)) + "</p>\n";
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
  return meaning_section(text);
}

Page validation_report(const std::string& title, const core::AnalysisResults& results,
                       const validate::Comparison& comparison, const std::vector<core::Preview>& previews,
                       const base::Progress& progress) {
  double lowest_r2 = 1.0;
  for (const validate::LineComparison& line : comparison.lines) lowest_r2 = std::min(lowest_r2, line.r2);
  const validate::RestitutionComparison& restitution = comparison.restitution;
  Html body = fmt::format(
      "<h1>{}</h1>\n<p class=\"soft\">Rehearsal by Glidelab: simulated, filmed, analysed from the images alone by the "
      "lines of the phase diagram and by the fit of the whole motion, and compared with the truth.</p>\n",
      escape(title));
  body += "<div class=\"tiles\">" +
          tile(fmt::format("{} / {}", comparison.detected, comparison.frames), "frames with the marker found") +
          tile(restitution.points.empty() ? "–" : base::number_text(restitution.rms_m * 1e3, 2) + " mm",
               "position error (rms)") +
          tile(comparison.lines.empty() ? "–" : base::r2_text(lowest_r2), "lowest R² of a line") +
          tile(fmt::format("{:.1f} s", comparison.wall_s), "to render and analyse") + "</div>\n";
  body += meaning_of(comparison);
  body += "<h2 id=\"comparison\">Truth and recovered values</h2>\n" + comparison_table(comparison);
  body +=
      "<p class=\"soft\">sd is the standard deviation that the analysis states, camera and scale included; least sd is "
      "the smallest that the position noise allows (Cramér-Rao bound); efficiency is (least sd / sd due to position "
      "noise)².</p>\n";
  body += figures(validation_plots(results, comparison));
  body += phase_section(results);
  body += recovered_section(results);
  body += details_sections(results, previews, progress);
  return page(title, body);
}

}  // namespace glidelab::report
