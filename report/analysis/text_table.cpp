#include "report/analysis/text_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/number_text.h"
#include "report/analysis/fitted_lines.h"
#include "report/analysis/meaning.h"
#include "report/text/configuration_name.h"
#include "report/text/quantity_names.h"

namespace glidelab::report {
namespace {

/// The text without control characters: a clip's name must not steer the terminal.
std::string printable(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return text;
}

/// Code points of UTF-8: every byte that does not continue one.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string quantity_text(const core::Quantity& quantity) {
  return quantity.estimate ? base::value_and_sd_text(quantity.estimate->value, quantity.estimate->sd) : "–";
}

std::string r2_of(const core::ConfigurationResult& configuration, int direction) {
  const core::LineFit* const line = line_of(configuration.lines, direction);
  return line == nullptr ? "–" : base::r2_text(line->r2);
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

}  // namespace

std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t first_number) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - width_of(row[i]), ' ');
      if (i > 0) line += "  ";
      line += i >= first_number ? padding + printable(row[i]) : printable(row[i]) + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

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
  rows = {{"configuration", "quantity", "of the lines as they are", "taken off for smoothing"}};
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
  std::string text = text_table(rows, 3);
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
  text += fmt::format("frames: {}, marker found in {}\ntime: {:.1f} s to render and analyse\n", comparison.frames,
                      comparison.detected, comparison.wall_s);
  return text;
}

}  // namespace glidelab::report
