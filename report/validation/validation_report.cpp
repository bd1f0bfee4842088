#include "report/validation/validation_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/number_text.h"
#include "report/analysis/sections.h"
#include "report/html/html.h"
#include "report/text/quantity_names.h"
#include "report/validation/comparison_text.h"
#include "report/validation/validation_plots.h"

namespace glidelab::report {
namespace {

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

Page validation_report(const std::string& title, const core::AnalysisResults& results,
                       const validate::Comparison& comparison, const std::vector<core::Preview>& previews,
                       const base::Progress& progress) {
  double lowest_r2 = 1.0;
  for (const validate::LineComparison& line : comparison.lines) lowest_r2 = std::min(lowest_r2, line.r2);
  const validate::RestitutionComparison& restitution = comparison.restitution;
  Html body = fmt::format(
      "<h1>{}</h1>\n<p class=\"soft\">Rehearsal by Glidelab: simulated, filmed, analysed from the pictures alone "
      "by the lines of the phase diagram and by the fit of the whole motion, and compared with the truth.</p>\n",
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
      "<p class=\"soft\">sd is the standard deviation that the analysis itself states, camera and scale included; "
      "least sd is what "
      "the noise of the positions alone allows at all (Cramér-Rao bound), and efficiency (least sd / noise's part of "
      "sd)².</p>\n";
  body += figures(validation_plots(results, comparison));
  body += phase_section(results);
  body += recovered_section(results);
  body += details_sections(results, previews, progress);
  return page(title, body);
}

}  // namespace glidelab::report
