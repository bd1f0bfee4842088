#include "report/diagnosis/plan_report.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/html/html.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {
namespace {

std::string alike_text(const std::vector<std::string>& names) {
  return names.empty() ? "–" : fmt::format("{}", fmt::join(names, ", "));
}

std::string seen_text(const diagnose::PlannedEffect& effect) {
  if (!effect.seen) return "not seen";
  const auto [name, unit] = name_and_unit(effect.key);
  const std::string size = size_text(effect.seen_from, 2, unit);
  if (effect.key == "v_c_m_s") return fmt::format("{} up to {}", name, size);  // the larger, the less there is
  if (effect.key == "n" || effect.key == "s") return fmt::format("{} differing from 1 by {}", name, size);
  return fmt::format("{} = {}", name, size);
}

/// Whether a diagnosis would name it and nothing else.
bool is_distinct(const diagnose::PlannedEffect& effect) {
  return effect.seen && effect.alike.empty();
}

std::string lead(const diagnose::Plan& plan) {
  std::size_t seen = 0;
  std::vector<std::string> alone;
  for (const diagnose::PlannedEffect& effect : plan.effects) {
    seen += effect.seen ? 1 : 0;
    if (is_distinct(effect)) alone.push_back(effect_name(effect.id));
  }
  return fmt::format(
      "These motions can show {} of the {} effects in the table, and distinguish {} of those from every other{}: "
      "{} clips, {} positions, with a position noise of {} µm.",
      seen, plan.effects.size(), alone.size(), alone.empty() ? "" : " (" + list_of(alone) + ")", plan.clips,
      plan.points, base::number_text(1e6 * plan.noise_m, 2));
}

/// The conclusions from the detectable effects; plain text.
std::string what_follows(const diagnose::Plan& plan) {
  if (plan.effects.empty()) return {};
  const bool any = std::any_of(plan.effects.begin(), plan.effects.end(), [](const auto& of) { return of.seen; });
  if (!any) return "With these motions no effect could be detected; a verdict of “none” would be meaningless.";
  return "With these motions a diagnosis can detect an effect of at least the smallest size that shows. If "
         "it finds none, "
         "smaller ones may still act, and those that are not seen may have any size.";
}

/// What to do about effects that look alike; empty if there are none.
std::string advice(const diagnose::Plan& plan) {
  for (const diagnose::PlannedEffect& effect : plan.effects) {
    if (!effect.alike.empty()) {
      return "Other motions may tell these effects apart: another mass, launches both ways and from rest, higher "
             "speeds, another inclination. Change the motions and plan again.";
    }
  }
  return {};
}

constexpr const char* kPlanMethod =
    "An effect counts as seen if it changes the positions by four standard deviations after everything that a fit may "
    "adjust (K, µ, inclinations, starts) has been adjusted, and if a diagnosis of this many clips may name it. Two "
    "effects are alike if the angle between the changes that remain is below 18 degrees (cosine 0.95). The table has "
    "the effects that change the positions in one way, more or less strongly; waves, late releases, missing frames, "
    "uneven frame times and outliers have no single such change and are not in it.";

}  // namespace

std::string plan_json(const diagnose::Plan& plan) {
  Json document;
  document["format"] = 1;
  document["clips"] = plan.clips;
  document["points"] = plan.points;
  put(document, "noise_m", plan.noise_m);
  document["effects"] = Json::array();
  for (const diagnose::PlannedEffect& effect : plan.effects) {
    Json one{{"id", effect.id}, {"parameter", effect.key}, {"seen", effect.seen}};
    if (effect.seen) put(one, "seen_from", effect.seen_from);
    one["alike"] = effect.alike;
    document["effects"].push_back(std::move(one));
  }
  document["isolability"] = {{"effects", plan.isolability.ids}, {"cosine", plan.isolability.cosine}};
  document["notes"] = notes_words(plan.notes);
  return json_text(document);
}

std::string plan_text(const diagnose::Plan& plan) {
  std::vector<std::vector<std::string>> rows = {{"effect", "smallest size that shows"}};
  std::string alike;
  for (const diagnose::PlannedEffect& effect : plan.effects) {
    rows.push_back({effect_name(effect.id), seen_text(effect)});
    if (effect.alike.empty()) continue;
    alike +=
        base::printable_text(fmt::format("  {}: {}", effect_name(effect.id), alike_text(effect_names(effect.alike)))) +
        "\n";
  }
  std::string text = lead(plan) + "\n\n" + text_table(rows, 2);
  if (!alike.empty()) text += "\nindistinguishable from:\n" + alike;
  std::string letters;
  for (const diagnose::PlannedEffect& effect : plan.effects) {
    const std::string meaning = effect_meaning(effect.id);
    if (effect.seen && !meaning.empty())
      letters += base::printable_text(fmt::format("{}: {}", effect_name(effect.id), meaning)) + "\n";
  }
  if (!letters.empty()) text += "\n" + letters;
  if (!advice(plan).empty()) text += fmt::format("\n{}\n", advice(plan));
  for (const std::string& note : notes_words(plan.notes)) text += "\n" + note + "\n";
  return text;
}

Page plan_page(const std::string& title, const diagnose::Plan& plan) {
  Html body = question_heading(title, "Which effects would these motions show?") +
              meaning_section(fmt::format("<p><b>{}</b> {}</p>\n", escape(lead(plan)), what_follows(plan)));
  if (!advice(plan).empty()) body += fmt::format("<p class=\"note\">{}</p>\n", advice(plan));
  for (const std::string& note : notes_words(plan.notes))
    body += fmt::format("<p class=\"soft\">{}</p>\n", escape(note));
  body += "<h2>What can be seen</h2>\n";
  HtmlTable table({"effect", "smallest size that shows", "indistinguishable from", "what it is"}, 4);
  table.stack_when_narrow(1);
  for (const diagnose::PlannedEffect& effect : plan.effects) {
    const std::string meaning = effect_meaning(effect.id);
    table.row({effect_html(effect.id), symbols_html(seen_text(effect)),
               is_distinct(effect) ? "<b>none</b>" : escape(alike_text(effect_names(effect.alike))),
               symbols_html(effect.words) + (meaning.empty() ? "" : ": " + symbols_html(meaning))});
  }
  body += table.str() + figures(isolability_plots(plan.isolability)) +
          fmt::format("<p class=\"soft\">{}</p>\n", kPlanMethod);
  return page(title, body);
}

}  // namespace glidelab::report
