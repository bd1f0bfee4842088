#include "report/diagnosis/diagnosis_text.h"

#include <fmt/format.h>

#include "base/text/number_text.h"
#include "report/diagnosis/explanation_text.h"
#include "report/diagnosis/line_report.h"
#include "report/diagnosis/next_step_words.h"
#include "report/diagnosis/note_words.h"
#include "report/diagnosis/verdict_words.h"
#include "report/text/gap_text.h"
#include "report/text/handy_units.h"
#include "report/text/text_table.h"

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

std::string gap_lines(const diagnose::GapSizes& gap, const char* of) {
  const diagnose::GapIntervals& over_clips = gap.interval95;
  std::string text;
  if (gap.shrink) text += "  it shrinks by " + shrink_text(gap) + " of what is above the floor\n";
  if (!over_clips.too_few) {
    text += fmt::format("  95 % over {}: {} before, {} after\n", of, interval_text(over_clips.before),
                        interval_text(over_clips.after));
  } else {
    text += "  " + too_few_words(over_clips) + "\n";
  }
  if (!gap.acceleration_before || !gap.acceleration_after) return text;
  const auto acceleration = [&](double size, const std::optional<diagnose::GapInterval>& interval) {
    return base::number_text(size, 3) + " m/s²" + (interval ? " (" + interval_text(interval) + ")" : "");
  };
  return text + fmt::format("  in acceleration {} before, {} after, noise included\n",
                            acceleration(*gap.acceleration_before, over_clips.acceleration_before),
                            acceleration(*gap.acceleration_after, over_clips.acceleration_after));
}

}  // namespace

std::string diagnosis_text(const diagnose::Diagnosis& diagnosis) {
  std::string text =
      fmt::format("verdict: {}\n\n{}\n", verdict_id(diagnosis.verdict), wrapped(verdict_words(diagnosis)));
  std::vector<std::vector<std::string>> rows = {{"explanation", "probability", "ln evidence"}};
  rows.push_back({"none", fmt::format("{:.3f}", diagnosis.none), "0"});
  rows.push_back({"unknown", fmt::format("{:.3f}", diagnosis.unknown), ""});
  for (std::size_t i = 0; i < diagnosis.ranking.size() && i < kRanked; ++i) {
    const auto& ranked = diagnosis.ranking[i];
    rows.push_back({explanation_id(ranked.explanation), fmt::format("{:.3f}", ranked.probability),
                    ranked.left_out ? "not weighed" : base::gain_text(ranked.log_evidence_gain)});
  }
  text += text_table(diagnosis.lines ? line_rows(*diagnosis.lines) : rows, diagnosis.lines ? 2 : 1) + "\n";
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
      text += fmt::format("{}: {}\n", effect.id, parameter_text(parameter));
    }
  }
  for (const diagnose::PictureFinding& finding : diagnosis.pictures) {
    if (finding.seen) text += "pictures: " + wrapped(finding.words);
  }
  if (diagnosis.gap) {
    text += fmt::format("gap of held-out {}: {:.3f} before, {:.3f} after (floor 1)\n",
                        diagnosis.lines ? "lines" : "clips", diagnosis.gap->before, diagnosis.gap->after);
    text += gap_lines(*diagnosis.gap, diagnosis.lines ? "lines" : "clips");
  }
  text += "\nnext: " + wrapped(next_step_words(diagnosis.next));
  for (const std::string& note : notes_words(diagnosis.notes)) text += "note: " + wrapped(note);
  return text;
}

}  // namespace glidelab::report
