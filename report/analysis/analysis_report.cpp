#include "report/analysis/analysis_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/math/distributions.h"
#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "core/result/why_unknown.h"
#include "report/analysis/doubts.h"
#include "report/analysis/fitted_curve.h"
#include "report/analysis/left_out_clips.h"
#include "report/analysis/motion_plots.h"
#include "report/analysis/note_words.h"
#include "report/analysis/sections.h"
#include "report/html/html.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr double kStraight = 0.99;  // R² below which a page should not call it a straight line

std::string sentence_of(const core::AnalysisResults& results, const core::ConfigurationResult& c) {
  std::string text;
  if (c.k_over_m_1_s.estimate) {
    const double rate = c.k_over_m_1_s.estimate->value;
    const double sd = c.k_over_m_1_s.estimate->sd;
    if (rate > kLeastDoubtSds * sd && c.k_over_m_1_s.estimate->low95 > 0.0) {
      text += fmt::format(
          "drag proportional to the speed, K/m = {} 1/s, takes it 63 % of the way to its final speed in {} s",
          base::value_and_sd_text(rate, sd), base::number_text(1.0 / rate, 3));
    } else if (is_below_zero(*c.k_over_m_1_s.estimate)) {
      text += fmt::format("K/m comes out as {} 1/s, below zero", base::value_and_sd_text(rate, sd));
    } else {
      text += fmt::format("drag proportional to the speed cannot be distinguished from zero ({} 1/s)",
                          base::value_and_sd_text(rate, sd));
    }
  }
  if (c.mu.estimate) {
    const double mu = c.mu.estimate->value, sd = c.mu.estimate->sd;
    const std::string size = base::value_and_sd_text(mu, sd);
    text += text.empty() ? "" : "; ";
    if (mu > kLeastDoubtSds * sd && c.mu.estimate->low95 > 0.0) {
      text += "Coulomb friction is µ = " + size;
    } else if (is_below_zero(*c.mu.estimate)) {
      text += fmt::format("µ comes out as {}, below zero", size);
    } else {
      text += fmt::format("Coulomb friction cannot be distinguished from zero (µ = {})", size);
    }
  }
  if (c.v_lim_m_s.estimate) {
    text += fmt::format("{}its terminal velocity is {} m/s", text.empty() ? "" : "; ",
                        base::value_and_sd_text(c.v_lim_m_s.estimate->value, c.v_lim_m_s.estimate->sd));
  }
  if (text.empty()) text = "the data determine neither drag nor friction; the table says why";
  return fmt::format("<li><b>{}:</b> {}.</li>\n", escape(configuration_name(results, c)), text);
}

/// If K is the same for all masses within its errors, the drag does not depend on the load.
std::string damping_sentence(const core::AnalysisResults& results) {
  constexpr double kSignificance = 0.01;  // probability that the chi² for equal K exceeds the limit
  struct Damping {
    double mass_kg, k_n_s_m, sd_n_s_m;
  };
  std::vector<Damping> all;
  double weight = 0.0, weighted = 0.0;
  for (const core::ConfigurationResult& c : results.configurations) {
    if (!c.k_over_m_1_s.estimate || !(c.k_over_m_1_s.estimate->sd > 0.0) || !(c.mass_kg > 0.0)) continue;
    all.push_back({c.mass_kg, c.k_over_m_1_s.estimate->value * c.mass_kg, c.k_over_m_1_s.estimate->sd * c.mass_kg});
    weight += std::pow(all.back().sd_n_s_m, -2);
    weighted += all.back().k_n_s_m * std::pow(all.back().sd_n_s_m, -2);
  }
  const bool masses_differ =
      std::ranges::any_of(all, [&](const Damping& one) { return one.mass_kg != all.front().mass_kg; });
  if (!masses_differ) return {};
  const double mean = weighted / weight;
  double chi2 = 0.0, widest = 0.0;
  for (const Damping& one : all) {
    chi2 += std::pow((one.k_n_s_m - mean) / one.sd_n_s_m, 2);
    widest = std::max(widest, std::abs(one.k_n_s_m / mean - 1.0));
  }
  if (chi2 <= base::chi2_upper_quantile(static_cast<double>(all.size() - 1), kSignificance)) {
    return fmt::format("<p>The damping constant is the same for all masses within its errors: K = {} N s/m.</p>\n",
                       base::value_and_sd_text(mean, 1.0 / std::sqrt(weight)));
  }
  return fmt::format(
      "<p>The damping constant K = m (K/m) is {} N s/m on average and differs between configurations by up to {} %, "
      "more than its errors alone allow.</p>\n",
      base::number_text(mean, 4), base::number_text(100.0 * widest, 2));
}

/// Says so where not every line is straight; empty otherwise.
std::string bent_lines_note(const core::AnalysisResults& results) {
  double worst = 1.0;
  for (const core::ConfigurationResult& configuration : results.configurations) {
    for (const core::LineFit& line : configuration.lines) worst = std::min(worst, line.r2);
  }
  if (!(worst < kStraight)) return {};
  return fmt::format(
      "<p>Not every a(v) is a clear straight line: the lowest R² is {}. Where the residuals "
      "below show a pattern and not just scatter, the friction is not of the assumed form.</p>\n",
      base::r2_text(worst));
}

/// That the law fits, if it has determined something that differs from zero and no line is bent.
std::string fits_sentence(const core::AnalysisResults& results) {
  if (!bent_lines_note(results).empty()) return {};
  for (const core::ConfigurationResult& c : results.configurations) {
    for (const auto& [name, quantity] : quantities_of(c)) {
      if (quantity->estimate && std::abs(quantity->estimate->value) > kLeastDoubtSds * quantity->estimate->sd) {
        return "<p>The points show no clear departure from the law (drag proportional to the speed, dry friction, "
               "gravity); <code>glidelab diagnose</code> tests it.</p>\n";
      }
    }
  }
  return {};
}

}  // namespace

std::string meaning_of(const core::AnalysisResults& results) {
  if (nothing_moves(results)) {
    return meaning_section(
        "<p class=\"note\"><b>Nothing moves in this recording.</b> K/m, µ, α and the terminal velocity are those of a "
        "motion: record a body that moves, or see whether the tracker or the sensor followed it.</p>\n");
  }
  std::string text;
  const std::vector<std::string> doubts = doubts_about(results);
  if (doubts.empty()) {
    text += fits_sentence(results) + "<ul>\n";
    for (const core::ConfigurationResult& c : results.configurations) text += sentence_of(results, c);
    text += "</ul>\n" + damping_sentence(results);
  } else {
    text += fmt::format("<p class=\"note\"><b>{}</b></p>\n<ul>\n", escape(doubts.back()));
    for (std::size_t i = 0; i + 1 < doubts.size(); ++i) text += fmt::format("<li>{}</li>\n", escape(doubts[i]));
    text +=
        "</ul>\n<p>A fit of that law still gives the numbers below, which need not be properties of the track or the "
        "glider; their ± would hold only if the law did.</p>\n";
    text += bent_lines_note(results);
  }
  return meaning_section(text);
}

namespace {

std::string quantity_text(const core::Quantity& quantity) {
  return quantity.estimate ? base::value_and_sd_text(quantity.estimate->value, quantity.estimate->sd) : "–";
}

std::string r2_of(const core::ConfigurationResult& configuration, int direction) {
  const core::LineFit* const line = line_of(configuration.lines, direction);
  return line == nullptr ? "–" : base::r2_text(line->r2);
}

/// "K/m = 2.7630 ± 0.0060 1/s" for one configuration, "K/m = 0.86 ± 0.01 to 2.76 ± 0.02 1/s" for several; empty if none
/// has it.
std::string value_words(const core::AnalysisResults& results, std::size_t which) {
  const core::Estimate *least = nullptr, *most = nullptr;
  const QuantityName& name = kQuantities[which];
  for (const core::ConfigurationResult& c : results.configurations) {
    const core::Quantity& quantity = *quantities_of(c)[which].quantity;
    if (!quantity.estimate) continue;
    if (least == nullptr || quantity.estimate->value < least->value) least = &*quantity.estimate;
    if (most == nullptr || quantity.estimate->value > most->value) most = &*quantity.estimate;
  }
  if (least == nullptr) return {};
  std::string values = base::value_and_sd_text(least->value, least->sd);
  if (most != least) values += " to " + base::value_and_sd_text(most->value, most->sd);
  return fmt::format("{} = {}{}", name.symbol, values, unit_suffix(name.unit));
}

/// The answer in one line: the values, and `doubt` if the law does not fit.
std::string analysis_answer(const core::AnalysisResults& results, std::string_view doubt) {
  std::string values;
  for (std::size_t which = 0; which < kQuantities.size(); ++which) {
    const std::string words = value_words(results, which);
    if (!words.empty()) values += (values.empty() ? "" : ", ") + words;
  }
  if (nothing_moves(results))
    return "Nothing moves in this recording: K/m, µ, α and the terminal velocity are those of a motion.";
  if (values.empty())
    return "The data determine none of K/m, µ, α or the terminal velocity; the reasons are below the table.";
  const std::string_view doubted = doubts_about(results).empty() ? "" : doubt;
  const std::size_t many = results.configurations.size();
  return fmt::format("{}{}{}.", values, many == 1 ? "" : fmt::format(" over {} configurations", many), doubted);
}

/// What is known of friction and slope where a single direction does not tell them apart: their sum.
std::string intercept_words(const core::AnalysisResults& results, const core::ConfigurationResult& c) {
  std::string words;
  for (const core::LineFit& line : c.lines) {
    words += fmt::format("{}: acceleration at v = 0: {} m/s² (g sin α {} µ g cos α, from v {} 0)\n",
                         base::printable_text(configuration_name(results, c)),
                         base::value_and_sd_text(line.a0_m_s2.value, line.a0_m_s2.sd), line.direction > 0 ? "−" : "+",
                         line.direction > 0 ? ">" : "<");
  }
  return words;
}

}  // namespace

std::string analysis_text(const core::AnalysisResults& results) {
  const std::vector<std::string> doubts = doubts_about(results);
  const std::string mark = doubts.empty() ? "" : " *";
  std::vector<std::vector<std::string>> rows = {{"configuration", "K/m (1/s)" + mark, "µ" + mark, "α (°)" + mark,
                                                 "terminal velocity (m/s)" + mark, "R² v<0", "R² v>0"}};
  std::string reasons;
  for (const core::ConfigurationResult& c : results.configurations) {
    rows.push_back({configuration_name(results, c), quantity_text(c.k_over_m_1_s), quantity_text(c.mu),
                    quantity_text(c.alpha_deg), quantity_text(c.v_lim_m_s), r2_of(c, -1), r2_of(c, 1)});
    if (!c.mu.estimate || !c.alpha_deg.estimate) reasons += intercept_words(results, c);
    for (const std::string& words : undetermined_words(c)) {
      reasons +=
          fmt::format("{}: {}\n", base::printable_text(configuration_name(results, c)), base::printable_text(words));
    }
  }
  std::string text = left_out_text(results.left_out) +
                     analysis_answer(results, " (but the law is in doubt: see below the table)") + "\n\n" +
                     text_table(rows, 1);
  if (!doubts.empty()) text += fmt::format("* {}\n", kIfItHeld);
  if (!reasons.empty()) text += fmt::format("\n{}", reasons);
  std::string notes;
  for (const core::ConfigurationResult& c : results.configurations) {
    for (const core::Note& note : c.notes) {
      notes += fmt::format("{}: {}\n", base::printable_text(configuration_name(results, c)),
                           base::printable_text(note_words(note)));
    }
  }
  for (const core::ClipResult& clip : results.clips) {
    for (const core::Note& note : clip.notes) {
      if (core::is_of_reading(note))
        notes += fmt::format("{}: {}\n", base::printable_text(clip.name), base::printable_text(note_words(note)));
    }
  }
  if (!notes.empty()) text.append("\n").append(notes);
  for (const std::string& doubt : doubts)
    text += fmt::format("{}{}\n", &doubt == &doubts.front() ? "\n" : "", base::printable_text(doubt));
  return text;
}

namespace {

constexpr std::size_t kFew = 2;  // configurations, whose values are shown one by one; of more they are in the table

/// K/m, µ, α and the terminal velocity with ± of each configuration, if there are few.
std::string value_tiles(const core::AnalysisResults& results) {
  if (results.configurations.size() > kFew) return {};
  std::string html;
  for (const core::ConfigurationResult& c : results.configurations) {
    html += "<div class=\"tiles\">";
    for (const auto& [name, quantity] : quantities_of(c)) {
      std::string what = with_unit(name.symbol, name.unit);
      if (results.configurations.size() > 1) what += ", " + configuration_name(results, c);
      html += tile(quantity_text(*quantity), what);
    }
    html += "</div>\n";
  }
  return html;
}

/// "12 clips, 2400 frames, the marker found in 2388".
std::string size_words(const core::AnalysisResults& results) {
  std::size_t frames = 0, detected = 0;
  bool images = false, speeds = false;
  for (const core::ClipResult& clip : results.clips) {
    images = images || !clip.sightings.empty();
    speeds = speeds || clip.speed_noise_m_s.has_value();
    frames += clip.frames;
    detected += clip.detected;
  }
  const std::size_t clips = results.clips.size();
  const std::string seen = images ? fmt::format("{} frames, the marker found in {}", frames, detected)
                                  : fmt::format("{} {}", detected, speeds ? "speeds" : "positions");
  return fmt::format("{} {}, {}", clips, clips == 1 ? "clip" : "clips", seen);
}

/// x(t) of the first clips, with the law overlaid.
Html fitted_section(const core::AnalysisResults& results) {
  constexpr std::size_t kMostFitted = 4;
  const std::vector<Plot> plots = fitted_plots(results, kMostFitted);
  if (plots.empty()) return {};
  return Html("<div id=\"fitted\">\n") + figures(plots) + "</div>\n";
}

/// The one plot of the page: a(v) of all configurations, whose slope is K/m and whose gap at v = 0 is Coulomb friction.
Html answer_plot(const core::AnalysisResults& results) {
  const std::optional<Plot> plot = phase_overview(results);
  return plot ? Html("<div id=\"overview\">\n") + figures({*plot}) + "</div>\n" : Html();
}

/// The ranges of the values over the configurations, which the table has one by one with their ±.
std::string ranges_answer(const core::AnalysisResults& results) {
  std::string text;
  for (std::size_t which = 0; which < kQuantities.size(); ++which) {
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const core::ConfigurationResult& c : results.configurations) {
      const core::Quantity& quantity = *quantities_of(c)[which].quantity;
      if (!quantity.estimate) continue;
      least = std::min(least, quantity.estimate->value);
      most = std::max(most, quantity.estimate->value);
    }
    if (!(least <= most)) continue;
    constexpr int kDigits = 3;
    const QuantityName& name = kQuantities[which];
    const std::string from = base::number_text(least, kDigits), to = base::number_text(most, kDigits);
    text += fmt::format("{}{} = {}{}", text.empty() ? "" : ", ", name.symbol, from == to ? from : from + " to " + to,
                        unit_suffix(name.unit));
  }
  return text.empty() ? analysis_answer(results, "")
                      : fmt::format("{} over {} configurations.", text, results.configurations.size());
}

/// The answer in words or, for few configurations, as tiles.
std::string answer_html(const core::AnalysisResults& results) {
  const std::string tiles = value_tiles(results);
  return tiles.empty() ? fmt::format("<p><b>{}</b></p>\n", escape(ranges_answer(results))) : tiles;
}

}  // namespace

Page analysis_report(const std::string& title, const core::AnalysisResults& results,
                     const std::vector<core::Preview>& previews, const base::Progress& progress,
                     const Html& with_causes) {
  Html body = question_heading(title, "What are K/m, µ and α?");
  body += left_out_html(results.left_out);
  // The numbers come first, unless they may not be those of the track: then that does.
  const bool in_doubt = !doubts_about(results).empty();
  const bool few = results.configurations.size() <= kFew;
  if (in_doubt) body += meaning_of(results);
  body += answer_html(results) + fmt::format("<p class=\"soft\">From the {}, {}.</p>\n",
                                             escape(estimator_name(results.estimator)), size_words(results));
  if (!in_doubt) body += few ? meaning_of(results) : fits_sentence(results);
  body += answer_plot(results) + recovered_section(results) + with_causes;
  if (!in_doubt) body += bent_lines_note(results);
  if (!in_doubt && !few) body += folded("In words", meaning_of(results));
  body += folded("Does the law fit the positions?", fitted_section(results));
  body += folded("Phase diagrams: near v = 0, and what the lines leave unexplained", phase_section(results));
  body += folded("Lines, camera, clips and method", details_sections(results, previews, progress));
  return page(title, body);
}

}  // namespace glidelab::report
