#include "report/diagnosis/diagnosis_lead.h"

#include <fmt/format.h>

#include "base/text/number_text.h"
#include "diagnose/effects/effect_list.h"
#include "report/diagnosis/next_step_words.h"
#include "report/diagnosis/note_words.h"
#include "report/diagnosis/verdict_words.h"
#include "report/html/html.h"

namespace glidelab::report {
namespace {

/// What the verdict says of K/m, µ and the inclination that an analysis of the same data gives; empty where they may be
/// taken as they are, or where it is open.
std::string consequence(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.verdict == diagnose::Verdict::effect) {
    const bool lost_only = diagnosis.effects.size() == 1 &&
                           diagnosis.effects.front().id == diagnose::ids::dropped_frames &&
                           diagnosis.effects.front().equivalent_to.empty();
    if (lost_only)
      return " An analysis of these data reports the losses that it finds, and corrects the times after them.";
    return " An analysis of these data leaves this out: its K/m, µ and inclination are those of a law without it, and "
           "may be "
           "off by more than their stated errors.";
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown) {
    return " Until the cause is found, K/m, µ and the inclination from an analysis of these data are numbers of a fit; "
           "they "
           "need not be properties of the track or the glider.";
  }
  return {};
}

}  // namespace

std::string probability_text(double probability) {
  return probability > 0.9995 ? "> 0.999" : probability < 0.0005 ? "< 0.001" : fmt::format("{:.3f}", probability);
}

bool one_model(const diagnose::Diagnosis& diagnosis) {
  return diagnosis.verdict == diagnose::Verdict::none &&
         (!diagnosis.gap || diagnosis.gap->before == diagnosis.gap->after);
}

std::string common_tiles(const diagnose::Diagnosis& diagnosis, const std::string& gap_words) {
  std::string text = tile(probability_text(diagnosis.none), "nothing is missing") +
                     tile(probability_text(diagnosis.unknown), "something without a name");
  if (!diagnosis.gap) return text;
  const std::string before = base::number_text(diagnosis.gap->before, 3);
  return text +
         tile(one_model(diagnosis) ? before : before + " → " + base::number_text(diagnosis.gap->after, 3), gap_words);
}

std::string diagnosis_meaning(const diagnose::Diagnosis& diagnosis) {
  std::string text = meaning_section(fmt::format("<p>{}{}</p>\n<p class=\"note\"><b>What to record next.</b> {}</p>\n",
                                                 escape(verdict_words(diagnosis)), consequence(diagnosis),
                                                 escape(next_step_words(diagnosis.next))));
  for (const std::string& note : notes_words(diagnosis.notes)) {
    text += fmt::format("<p class=\"soft\">{}</p>\n", escape(note));
  }
  return text;
}

}  // namespace glidelab::report
