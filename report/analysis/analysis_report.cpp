#include "report/analysis/analysis_report.h"

#include <fmt/format.h>

#include <vector>

#include "base/text/number_text.h"
#include "report/analysis/fitted_lines.h"
#include "report/analysis/meaning.h"
#include "report/analysis/sections.h"
#include "report/html/html.h"
#include "report/text/quantity_names.h"
#include "report/text/result_names.h"
#include "report/text/text_table.h"

namespace glidelab::report {
namespace {

std::string quantity_text(const core::Quantity& quantity) {
  return quantity.estimate ? base::value_and_sd_text(quantity.estimate->value, quantity.estimate->sd) : "–";
}

std::string r2_of(const core::ConfigurationResult& configuration, int direction) {
  const core::LineFit* const line = line_of(configuration.lines, direction);
  return line == nullptr ? "–" : base::r2_text(line->r2);
}

}  // namespace

std::string analysis_text(const core::AnalysisResults& results) {
  std::vector<std::vector<std::string>> rows = {
      {"mass (kg)", "incline (°)", "group", "K/m (1/s)", "µ", "α (°)", "v_lim (m/s)", "R² v<0", "R² v>0"}};
  std::string reasons;
  for (const core::ConfigurationResult& c : results.configurations) {
    rows.push_back({fmt::format("{:.6g}", c.mass_kg), fmt::format("{:.4g}", c.incline_deg), c.group,
                    quantity_text(c.k_over_m_1_s), quantity_text(c.mu), quantity_text(c.alpha_deg),
                    quantity_text(c.v_lim_m_s), r2_of(c, -1), r2_of(c, 1)});
    for (const auto& [name, quantity] : quantities_of(c)) {
      if (!quantity->estimate) {
        reasons += fmt::format("{}: no {}: {}\n", printable(configuration_name(results, c)), name.symbol,
                               printable(quantity->why));
      }
    }
  }
  std::string text = text_table(rows, 3);
  if (!reasons.empty()) text += fmt::format("\n{}", reasons);
  rows = {{"configuration", "quantity", "uncorrected", "subtracted for smoothing"}};
  std::string notes;
  for (const core::ConfigurationResult& c : results.configurations) {
    for (const auto& [name, quantity] : quantities_of(c)) {
      if (!quantity->estimate || !quantity->smoothing_correction) continue;
      const double sd = quantity->estimate->sd, correction = *quantity->smoothing_correction;
      rows.push_back({configuration_name(results, c), std::string(name.symbol),
                      base::value_text(quantity->estimate->value - correction, sd), base::error_text(-correction, sd)});
    }
    for (const std::string& note : c.notes) {
      notes += fmt::format("{}: {}\n", printable(configuration_name(results, c)), printable(note));
    }
  }
  if (rows.size() > 1) text.append("\n").append(text_table(rows, 2));
  if (!notes.empty()) text.append("\n").append(notes);
  const std::vector<std::string> doubts = doubts_about(results);
  for (const std::string& doubt : doubts)
    text += fmt::format("{}{}\n", &doubt == &doubts.front() ? "\n" : "", printable(doubt));
  return text;
}

Page analysis_report(const std::string& title, const core::AnalysisResults& results,
                     const std::vector<core::Preview>& previews, const base::Progress& progress) {
  std::size_t frames = 0;
  std::size_t detected = 0;
  bool pictures = false;
  for (const core::ClipResult& clip : results.clips) {
    pictures = pictures || !clip.sightings.empty();
    frames += clip.frames;
    detected += clip.detected;
  }
  Html body = fmt::format("<h1>{}</h1>\n<p class=\"soft\">Analysis by Glidelab, estimator {}.</p>\n", escape(title),
                          escape(results.estimator));
  body += fmt::format("<div class=\"tiles\">{}{}{}{}</div>\n",
                      tile(std::to_string(results.configurations.size()), "configurations"),
                      tile(std::to_string(results.clips.size()), "clips"), tile(std::to_string(frames), "frames"),
                      tile(std::to_string(detected), pictures ? "with the marker found" : "positions"));
  body += meaning_of(results);
  body += recovered_section(results);
  body += phase_section(results);
  body += details_sections(results, previews, progress);
  return page(title, body);
}

}  // namespace glidelab::report
