#include "report/diagnosis_text.h"

#include <fmt/format.h>

#include "report/number_text.h"
#include "report/text_table.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kRanked = 6;
constexpr std::size_t kLineWidth = 110;

std::string wrapped(const std::string& text) {
  std::string lines, line;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t space = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, space - at);
    if (!line.empty() && line.size() + 1 + word.size() > kLineWidth) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
    at = space + 1;
  }
  return lines + line + "\n";
}

}  // namespace

std::string diagnosis_text(const diagnose::Diagnosis& diagnosis) {
  std::string text = fmt::format("verdict: {}\n\n{}\n", diagnosis.verdict, wrapped(diagnosis.summary));
  std::vector<std::vector<std::string>> rows = {{"explanation", "probability", "log evidence"}};
  rows.push_back({"none", fmt::format("{:.3f}", diagnosis.none), "0"});
  rows.push_back({"unknown", fmt::format("{:.3f}", diagnosis.unknown), ""});
  for (std::size_t i = 0; i < diagnosis.ranking.size() && i < kRanked; ++i) {
    const auto& ranked = diagnosis.ranking[i];
    rows.push_back({ranked.id, fmt::format("{:.3f}", ranked.probability), gain_text(ranked.log_evidence_gain)});
  }
  text += text_table(rows, 1) + "\n";
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
      text += fmt::format("{}.{} = {}\n", effect.id, parameter.key, value_and_sd_text(parameter.value, parameter.sd));
    }
  }
  for (const diagnose::PictureFinding& finding : diagnosis.pictures) {
    if (finding.seen) text += "pictures: " + wrapped(finding.words);
  }
  if (diagnosis.gap) {
    text += fmt::format("gap of held-out clips: {:.3f} before, {:.3f} after (floor 1)\n", diagnosis.gap->before,
                        diagnosis.gap->after);
  }
  text += "\nnext: " + wrapped(diagnosis.next_experiment);
  for (const std::string& note : diagnosis.notes) text += "note: " + wrapped(note);
  return text;
}

}  // namespace glidelab::report
