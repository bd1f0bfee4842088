#include "report/diagnosis/given_causes_report.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "core/result/quantity.h"
#include "report/analysis/doubts.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/text/display_text.h"
#include "report/text/why_words.h"

namespace glidelab::report {
namespace {

std::vector<std::string> names_of(const diagnose::GivenCauses& given) {
  std::vector<std::string> ids;
  for (const diagnose::GivenCause& cause : given.causes) ids.push_back(cause.id);
  return effect_names(ids);
}

/// The fit of the same group and mass at the nearest stated inclination (clips that state slightly different
/// inclinations may share a set-up there); null: none of its clips took part.
const diagnose::RecoveredConfiguration* counterpart_of(const core::ConfigurationResult& configuration,
                                                       const diagnose::GivenCauses& given) {
  const diagnose::RecoveredConfiguration* nearest = nullptr;
  for (const diagnose::RecoveredConfiguration& other : given.recovered) {
    if (other.group != configuration.group || other.mass_kg != configuration.mass_kg) continue;
    const auto off = [&](const auto& of) { return std::abs(of.incline_deg - configuration.incline_deg); };
    if (nearest == nullptr || off(other) < off(*nearest)) nearest = &other;
  }
  return nearest;
}

std::string value_of_quantity(const core::Quantity& quantity) {
  return quantity.estimate ? base::value_and_sd_text(quantity.estimate->value, quantity.estimate->sd) : "–";
}

std::string interval_of(const core::Quantity& quantity) {
  if (!quantity.estimate) return "–";
  const core::Estimate& of = *quantity.estimate;
  return fmt::format("{} to {}", base::value_text(of.low95, of.sd), base::value_text(of.high95, of.sd));
}

/// Whether the law alone is in doubt: its ± then refer to a law that does not hold.
bool law_fails(const core::AnalysisResults& results) {
  return !doubts_about(results).empty();
}

/// Configuration and quantity; by the law alone; with the causes, and its 95 % interval. Also the reasons for missing
/// values.
struct BothColumns {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> why;
};

BothColumns both_columns(const core::AnalysisResults& results, const diagnose::GivenCauses& given) {
  BothColumns both;
  both.rows = {{"configuration", "quantity", law_fails(results) ? "the law alone *" : "the law alone",
                given.causes.size() == 1 ? "with the effect" : "with the effects", "95 % interval"}};
  for (const core::ConfigurationResult& configuration : results.configurations) {
    const std::string name = configuration_name(results, configuration);
    const diagnose::RecoveredConfiguration* with = counterpart_of(configuration, given);
    for (const QuantityName& quantity : kQuantities) {
      const core::Quantity& before = core::value_of(configuration, quantity.which);
      const core::Quantity after = with != nullptr ? core::value_of(*with, quantity.which) : core::Quantity{};
      both.rows.push_back(
          {name, heading_of(quantity.key), value_of_quantity(before), value_of_quantity(after), interval_of(after)});
      if (after.estimate) continue;
      both.why.push_back(fmt::format("{}: no {} with {}: {}", name, quantity.symbol,
                                     given.causes.size() == 1 ? "the effect" : "the effects",
                                     with != nullptr ? why_words(after.why) : "its clips hold too little free motion"));
    }
  }
  return both;
}

/// "quadratic drag: c = 0.0031 ± 0.0002 kg/m"
std::vector<std::string> size_lines(const diagnose::GivenCauses& given) {
  std::vector<std::string> lines;
  for (const diagnose::GivenCause& cause : given.causes) {
    std::string text = effect_name(cause.id);
    const std::string meaning = effect_meaning(cause.id);
    for (const diagnose::DiagnosedParameter& parameter : cause.parameters) {
      text += fmt::format("{}{}", &parameter == &cause.parameters.front() ? ": " : ", ", parameter_text(parameter));
    }
    if (!meaning.empty()) text += fmt::format(" ({})", meaning);
    lines.push_back(std::move(text));
  }
  return lines;
}

/// The effect of the causes on the gap, and what a reader must know about the numbers.
std::vector<std::string> sentences_of(const core::AnalysisResults& results, const diagnose::GivenCauses& given) {
  std::vector<std::string> sentences;
  const std::string before = base::digits_text(given.gap_before, 3), after = base::digits_text(given.gap_after, 3);
  if (given.gap_before - given.gap_after > diagnose::kClearGap * given.standard_error) {
    sentences.push_back(fmt::format("The gap of held-out clips falls from {} to {} times the noise.", before, after));
  } else {
    sentences.push_back(fmt::format(
        "The gap of held-out clips does not fall ({} before, {} after, in units of the noise): these clips do not show "
        "that this acts.",
        before, after));
  }
  if (given.gap_after > 1.0 + diagnose::kClearGap * given.standard_error) {
    sentences.emplace_back("What is left counts as noise in the ± and in the intervals.");
  }
  if (law_fails(results)) {
    sentences.emplace_back("* The law alone does not fit these clips: its ± would hold only if it did.");
  }
  if (!given.converged) {
    sentences.emplace_back("The fit did not reach a minimum: its numbers are those of its last step.");
  }
  return sentences;
}

std::string heading_of(const diagnose::GivenCauses& given) {
  const std::vector<std::string> names = names_of(given);
  return fmt::format("With {} in the model: {}", names.size() == 1 ? "this effect" : "these effects", list_of(names));
}

}  // namespace

Html given_causes_section(const core::AnalysisResults& results, const diagnose::GivenCauses& given) {
  std::string text = fmt::format("<h2 id=\"with\">{}</h2>\n<ul>\n", escape(heading_of(given)));
  for (const std::string& line : size_lines(given)) text += fmt::format("<li>{}</li>\n", escape(line));
  text += "</ul>\n<p>";
  for (const std::string& sentence : sentences_of(results, given)) text += escape(sentence) + " ";
  text += "</p>\n";
  const BothColumns both = both_columns(results, given);
  HtmlTable table(both.rows.front(), 2);
  for (std::size_t r = 1; r < both.rows.size(); ++r) {
    std::vector<std::string> cells;
    for (const std::string& cell : both.rows[r]) cells.push_back(escape(cell));
    table.row(cells);
  }
  text += table.str();
  std::vector<std::string> notes = both.why;
  for (const std::string& note : notes_words(given.notes)) notes.push_back(note);
  if (!notes.empty()) text += "<ul class=\"soft\">\n";
  for (const std::string& note : notes) text += fmt::format("<li>{}</li>\n", escape(note));
  if (!notes.empty()) text += "</ul>\n";
  return text;
}

std::string given_causes_text(const core::AnalysisResults& results, const diagnose::GivenCauses& given) {
  std::string text = fmt::format("\n{}\n", heading_of(given));
  for (const std::string& line : size_lines(given)) text += fmt::format("  {}\n", base::printable_text(line));
  const BothColumns both = both_columns(results, given);
  text += "\n" + text_table(both.rows, 2) + "\n";
  for (const std::string& sentence : sentences_of(results, given)) text += sentence + "\n";
  for (const std::string& why : both.why) text += base::printable_text(why) + "\n";
  for (const std::string& note : notes_words(given.notes)) text += base::printable_text(note) + "\n";
  return text;
}

Json given_causes_json(const diagnose::GivenCauses& given) {
  Json object;
  object["effects"] = Json::array();
  for (const diagnose::GivenCause& cause : given.causes) {
    object["effects"].push_back({{"id", cause.id}, {"parameters", parameters_json(cause.parameters)}});
  }
  put(object["gap"], "before", given.gap_before);
  put(object["gap"], "after", given.gap_after);
  put(object["gap"], "standard_error", given.standard_error);
  object["converged"] = given.converged;
  object["recovered"] = recovered_json(given.recovered);
  object["notes"] = notes_words(given.notes);
  return object;
}

}  // namespace glidelab::report
