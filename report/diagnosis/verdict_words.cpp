#include "report/diagnosis/verdict_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text/size_text.h"
#include "report/diagnosis/explanation_text.h"
#include "report/diagnosis/line_words.h"
#include "report/diagnosis/note_words.h"

namespace glidelab::report {
namespace {

std::string times(double gap) {
  return gap < 10.0 ? fmt::format("{:.2f}", gap) : fmt::format("{:.0f}", gap);
}

std::string list_of(const std::vector<std::string>& words, const std::string& last = " and ") {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? last : ", ") + words[i];
  }
  return text;
}

std::string count_in_words(std::size_t count) {
  static const std::array<const char*, 9> kWords = {"two",   "three", "four", "five", "six",
                                                    "seven", "eight", "nine", "ten"};
  return count >= 2 && count - 2 < kWords.size() ? kWords[count - 2] : fmt::format("{}", count);
}

/// One effect, or the set that these data cannot tell apart, before any of its members.
std::string claim(const diagnose::DiagnosedEffect& effect) {
  if (effect.alike.empty()) {
    return fmt::format("{} ({}, {})", effect.words, effect.id, percent(effect.probability));
  }
  std::vector<std::string> members;
  for (const diagnose::AlikeEffect& one : effect.alike) {
    members.push_back(one.probability ? fmt::format("{} ({}, {})", one.words, one.id, percent(*one.probability))
                                      : fmt::format("{} ({})", one.words, one.id));
  }
  return fmt::format("one of these {}, {} together, and cannot tell which: {}", count_in_words(members.size()),
                     percent(effect.joint_probability), list_of(members, ", or "));
}

std::string in_words(const std::string& variable) {
  if (variable == "x_m") return "the position on the track";
  if (variable == "v_m_s") return "the speed";
  if (variable == "t_s") return "the time";
  if (variable == "mass_kg") return "the mass";
  if (variable == "group") return "the set-up";
  return variable;
}

std::string clip_gap_words(const diagnose::Diagnosis& diagnosis) {
  if (!diagnosis.gap) return "";
  const diagnose::GapSizes& gap = *diagnosis.gap;
  std::string text = fmt::format(
      " Held-out clips lie {} times as far from the nominal model (drag proportional to the speed, dry friction, "
      "gravity) as their noise explains",
      times(gap.before));
  if (diagnosis.verdict == diagnose::Verdict::effect && gap.shrink) {
    const bool one = diagnosis.effects.size() == 1;
    text += fmt::format("; with {} in the model, {} times (1 is the floor)",
                        !one                                      ? "these effects"
                        : diagnosis.effects.front().alike.empty() ? "this effect"
                                                                  : diagnosis.effects.front().id,
                        times(gap.after));
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown && gap.shrink && gap.after < gap.before) {
    text += fmt::format(
        "; with a free curve that all clips share, its size learnt from the other clips, {} times (1 is the floor)",
        times(gap.after));
  }
  return text + ".";
}

/// Each note's sentence, in a row.
template <class Notes>
std::string sentences(const Notes& notes) {
  std::string text;
  for (const auto& note : notes) text += (text.empty() ? "" : " ") + note_words(note);
  return text;
}

/// The nominal model follows the positions to within their noise, but its parameters are impossible.
std::string wrongly_stated_words(const diagnose::Diagnosis& diagnosis) {
  const std::string sure = percent(diagnosis.unknown);
  if (!diagnosis.limits.driving.empty()) {
    return fmt::format("{} Residuals no larger than the noise therefore do not show that nothing is missing ({}).",
                       sentences(diagnosis.limits.driving), sure);
  }
  return fmt::format(
      "{} The nominal model explains the motion to within its noise, and none of the effects that this program knows "
      "shifts an inclination so far: a statement is wrong, or something acts as an inclination does ({}).",
      sentences(diagnosis.limits.contradicted), sure);
}

/// "3.6 ± 0.2 mm at 0.34 m", or the size alone where a curve is not what tells it.
std::string largest_words(const diagnose::GapRegion& region) {
  if (!region.at || !region.size_sd) return base::size_text(region.size, 2, region.unit);
  const std::string unit = base::name_and_unit(region.variable).unit;
  return fmt::format("{} {} {}", base::size_and_sd_text(region.size, *region.size_sd, region.unit),
                     region.variable == "t_s" ? "after" : "at", base::size_text(*region.at, 3, unit));
}

std::string clip_verdict(const diagnose::Diagnosis& diagnosis) {
  if (only_statements_fail(diagnosis)) {
    return wrongly_stated_words(diagnosis) + clip_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::none && !diagnosis.ranking.empty() &&
      diagnosis.ranking.front().probability > diagnosis.none) {
    return fmt::format(
               "These data leave it open whether anything is missing. The likeliest explanation is {} ({}), but "
               "nothing missing ({}) is not ruled out at three to one, so no effect is claimed.",
               explanation_id(diagnosis.ranking.front().explanation), percent(diagnosis.ranking.front().probability),
               percent(diagnosis.none)) +
           clip_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::none) {
    return fmt::format(
               "Nothing is missing that these data could show ({}): the nominal model explains them to within their "
               "noise.",
               percent(diagnosis.none)) +
           clip_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown) {
    std::string text = fmt::format("Something is missing, and it is none of the effects that this program knows ({}).",
                                   percent(diagnosis.unknown));
    if (!diagnosis.regions.empty()) {
      const diagnose::GapRegion& region = diagnosis.regions.front();
      text += fmt::format(" What is left depends most on {}", in_words(region.variable));
      if (!region.clip.empty()) text = text + " and is largest in clip " + region.clip;
      if (region.lacking) {
        text += fmt::format(
            ": {}. These data do not tell how large it is: the estimate, {}, is far more than the nominal model lacks "
            "anywhere ({}).",
            region.what, base::size_text(region.size, 2, region.unit),
            base::size_text(*region.lacking, 2, region.unit));
      } else {
        text += fmt::format(": {} of up to {}.", region.what, largest_words(region));
      }
    }
    return text + clip_gap_words(diagnosis);
  }
  std::vector<std::string> words;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) words.push_back(claim(effect));
  std::string text = fmt::format("The data show {}.", list_of(words));
  return text + clip_gap_words(diagnosis);
}

}  // namespace

std::string verdict_words(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.lines) return line_words(diagnosis);
  const diagnose::VerdictLimits& limits = diagnosis.limits;
  std::string text = clip_verdict(diagnosis);
  if (diagnosis.verdict == diagnose::Verdict::none) {
    if (!limits.contradicted.empty()) text = sentences(limits.contradicted) + " " + text;
  } else if (!only_statements_fail(diagnosis)) {
    if (!limits.driving.empty()) text += " " + sentences(limits.driving);
    if (!limits.contradicted.empty()) text += " " + sentences(limits.contradicted);
  }
  return limits.set_aside ? note_words(*limits.set_aside) + " " + text : text;
}

std::string too_few_words(const diagnose::GapIntervals& intervals) {
  if (!intervals.too_few) return {};
  return fmt::format("{} clip{} cannot tell how much clips differ: an interval needs three or more", *intervals.too_few,
                     *intervals.too_few == 1 ? "" : "s");
}

}  // namespace glidelab::report
