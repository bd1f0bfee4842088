#include "report/diagnosis/diagnosis_answer.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/text/number_text.h"
#include "report/diagnosis/cause_waterfall.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/words/cause_words.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

std::string region_size(const diagnose::GapRegion& region) {
  const NamedUnit of = name_and_unit(region.unit);
  const std::string& unit = of.unit.empty() ? region.unit : of.unit;
  return region.size_sd ? size_and_sd_text(region.size, *region.size_sd, unit) : size_text(region.size, 2, unit);
}

/// A table of texts; the first row is its header, and the first cell of each row heads it on a narrow screen.
std::string html_of(const std::vector<std::vector<std::string>>& rows) {
  const auto cells = [](const std::vector<std::string>& row) {
    std::vector<std::string> html;
    for (const std::string& cell : row) html.push_back(escape(cell));
    return html;
  };
  HtmlTable table(cells(rows.front()));
  if (rows.front().size() > 3) table.stack_when_narrow(1);
  for (std::size_t r = 1; r < rows.size(); ++r) table.row(cells(rows[r]));
  return table.str();
}

std::string paragraph(const std::string& words, const char* kind = "") {
  return words.empty() ? "" : fmt::format("<p{}>{}</p>\n", kind, escape(words));
}

std::string recovered_section(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.recovered.empty()) return {};
  std::string text = "<h2>K/m, µ, α and terminal velocity</h2>\n";
  for (const RecoveredTable& table : recovered_tables(diagnosis)) {
    text += paragraph(fmt::format("For each configuration, {}.{}", with_words(table.with),
                                  diagnosis.remainder ? " The standard deviations include the remainder and the spread "
                                                        "among the other likely explanations."
                                                      : ""));
    text += html_of(table.rows);
    for (const std::string& why : table.why) text += paragraph(why + ".", " class=\"soft\"");
  }
  return text;
}

constexpr std::size_t kPlacesTold = 4;

/// If no cause is named, the curve that would fill the gap over the most important variable.
std::vector<Plot> likeliest_curve(const diagnose::Diagnosis& diagnosis,
                                  const std::vector<diagnose::GapRegion>& regions) {
  if (diagnosis.verdict != diagnose::Verdict::unknown || regions.empty()) return {};
  for (const diagnose::GapCurve& curve : diagnosis.curves) {
    if (curve.variable != regions.front().variable || curve.what != regions.front().what) continue;
    diagnose::Diagnosis alone;
    alone.curves = {curve};
    return where_plots(alone);
  }
  return {};
}

Html rest_section(const diagnose::Diagnosis& diagnosis) {
  std::string words;
  std::vector<diagnose::GapRegion> regions;
  const bool any_left = diagnosis.remainder && !leaves_nothing(*diagnosis.remainder);
  if (any_left) {
    words = paragraph(remainder_words(*diagnosis.remainder));
    regions = diagnosis.remainder->regions;
  } else if (!diagnosis.remainder && diagnosis.verdict == diagnose::Verdict::unknown) {
    regions = diagnosis.regions;
  }
  if (regions.size() > kPlacesTold) regions.resize(kPlacesTold);
  words += region_table(regions) + paragraph(levels_words(diagnosis));
  if (words.empty()) return {};
  const char* const heading = any_left              ? "Where the rest lies"
                              : diagnosis.remainder ? "Where the nominal model holds"
                                                    : "Where the gap lies";
  return fmt::format("<h2>{}</h2>\n", heading) + words + figures(likeliest_curve(diagnosis, regions));
}

}  // namespace

std::string member_section(const diagnose::Diagnosis& diagnosis) {
  std::string text;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    const auto rows = member_rows(effect);
    if (rows.empty() || rows.size() < 3) continue;  // with only one there is no difference
    text += fmt::format("<h3>{}</h3>\n", effect_html(effect.id)) + html_of(rows);
  }
  return text.empty() ? text : "<h2>What differs</h2>\n" + text;
}

std::string region_table(const std::vector<diagnose::GapRegion>& regions) {
  HtmlTable table({"over", "what", "from", "to", "largest", "at", "size / sd, where clearest"}, 2);
  for (const diagnose::GapRegion& region : regions) {
    const bool named = region.variable == diagnose::GapVariable::set_up;  // a set-up has a number unknown to the reader
    const std::string over = named ? "one of the set-ups" : axis_of(region.variable);
    table.row({escape(over + (region.clip.empty() ? "" : " of " + region.clip)), escape(to_text(region.what)),
               named ? "–" : base::number_text(region.from, 3), named ? "–" : base::number_text(region.to, 3),
               region.lacking ? "not known" : escape(region_size(region)),
               region.at && !region.lacking ? base::number_text(*region.at, 3) : "–",
               base::number_text(region.excess, 2)});
  }
  return table.empty() ? "" : table.str();
}

Html answer_sections(const diagnose::Diagnosis& diagnosis) {
  Html html;
  const std::vector<Plot> waterfall = waterfall_plots(diagnosis);
  if (!waterfall.empty()) html += "<h2>What explains the gap</h2>\n" + figures(waterfall);
  html += member_section(diagnosis) + recovered_section(diagnosis);
  html += rest_section(diagnosis);
  html += next_step_note(diagnosis);
  return html;
}

}  // namespace glidelab::report
