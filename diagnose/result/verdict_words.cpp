#include "diagnose/result/verdict_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text/size_text.h"

namespace glidelab::diagnose {
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
std::string claim(const DiagnosedEffect& effect) {
  if (effect.alike.empty()) {
    return fmt::format("{} ({}, {})", effect.words, effect.id, percent(effect.probability));
  }
  std::vector<std::string> members;
  for (const AlikeEffect& one : effect.alike) {
    members.push_back(one.probability ? fmt::format("{} ({}, {})", one.words, one.id, percent(*one.probability))
                                      : fmt::format("{} ({})", one.words, one.id));
  }
  return fmt::format("one of these {}, {} together, and cannot tell which: {}", count_in_words(members.size()),
                     percent(effect.joint_probability), list_of(members, ", or "));
}

std::string in_words(const std::string& variable) {
  if (variable == "x_m") return "the place on the track";
  if (variable == "v_m_s") return "the speed";
  if (variable == "t_s") return "the time";
  if (variable == "mass_kg") return "the mass";
  if (variable == "group") return "the set-up";
  return variable;
}

std::string gap_words(const Diagnosis& diagnosis) {
  if (!diagnosis.gap) return "";
  const GapSizes& gap = *diagnosis.gap;
  std::string text = fmt::format(
      " Clips that were left out of the fit lie {} times as far from the usual model (drag in proportion to the speed, "
      "dry friction, gravity) as their noise explains",
      times(gap.before));
  if (diagnosis.verdict == "effect" && gap.shrink) {
    const bool one = diagnosis.effects.size() == 1;
    text += fmt::format("; with {} in the model it is {} times (1 is the floor)",
                        !one                                      ? "these effects"
                        : diagnosis.effects.front().alike.empty() ? "this effect"
                                                                  : diagnosis.effects.front().id,
                        times(gap.after));
  }
  if (diagnosis.verdict == "unknown" && gap.shrink && gap.after < gap.before) {
    text += fmt::format(
        "; with a free curve that all clips share, its size learnt from the other clips, it is {} times (1 is the "
        "floor)",
        times(gap.after));
  }
  return text + ".";
}

std::string all_of(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += sentence + " ";
  return text;
}

/// The usual model follows the positions to their noise, and what it says cannot be.
std::string wrongly_stated_words(const Diagnosis& diagnosis) {
  const std::string sure = percent(diagnosis.unknown);
  if (!diagnosis.limits.driving.empty()) {
    return fmt::format("{}That no clip leaves more than its noise is no sign that nothing is missing ({}).",
                       all_of(diagnosis.limits.driving), sure);
  }
  return fmt::format(
      "{}The usual model explains the motion by itself to its noise, and none of the effects that this program knows "
      "takes an inclination so far: what is stated is wrong, or something acts as an inclination does ({}).",
      all_of(diagnosis.limits.contradicted), sure);
}

/// "3.6 ± 0.2 mm at 0.34 m", or the size alone where a curve is not what tells it.
std::string largest_words(const GapRegion& region) {
  if (!region.at || !region.size_sd) return base::size_text(region.size, 2, region.unit);
  const std::string unit = base::name_and_unit(region.variable).unit;
  return fmt::format("{} {} {}", base::size_and_sd_text(region.size, *region.size_sd, region.unit),
                     region.variable == "t_s" ? "after" : "at", base::size_text(*region.at, 3, unit));
}

std::string verdict_words(const Diagnosis& diagnosis) {
  if (only_statements_fail(diagnosis)) {
    return wrongly_stated_words(diagnosis) + gap_words(diagnosis);
  }
  if (diagnosis.verdict == "none" && !diagnosis.ranking.empty() &&
      diagnosis.ranking.front().probability > diagnosis.none) {
    return fmt::format(
               "These data leave it open whether anything is missing. Likeliest is {} ({}); that nothing is ({}) is "
               "not "
               "ruled out at three to one, so that no effect is claimed.",
               diagnosis.ranking.front().id, percent(diagnosis.ranking.front().probability), percent(diagnosis.none)) +
           gap_words(diagnosis);
  }
  if (diagnosis.verdict == "none") {
    return fmt::format(
               "Nothing is missing that these data could show ({}): the usual model explains them to their noise.",
               percent(diagnosis.none)) +
           gap_words(diagnosis);
  }
  if (diagnosis.verdict == "unknown") {
    std::string text = fmt::format("Something is missing, and it is none of the effects that this program knows ({}).",
                                   percent(diagnosis.unknown));
    if (!diagnosis.regions.empty()) {
      const GapRegion& region = diagnosis.regions.front();
      text += fmt::format(" What is left depends most on {}", in_words(region.variable));
      if (!region.clip.empty()) text = text + " and is largest in clip " + region.clip;
      if (region.lacking) {
        text += fmt::format(
            ": {}. How large it is these data do not tell: the estimate, {}, is far more than the usual model lacks "
            "anywhere ({}).",
            region.what, base::size_text(region.size, 2, region.unit),
            base::size_text(*region.lacking, 2, region.unit));
      } else {
        text += fmt::format(": {} of up to {}.", region.what, largest_words(region));
      }
    }
    return text + gap_words(diagnosis);
  }
  std::vector<std::string> words;
  for (const DiagnosedEffect& effect : diagnosis.effects) words.push_back(claim(effect));
  std::string text = fmt::format("The data show {}.", list_of(words));
  return text + gap_words(diagnosis);
}

}  // namespace

std::string percent(double probability) {
  if (probability > 0.995) return "more than 99 %";
  if (probability < 0.005) return "less than 1 %";
  return fmt::format("{:.0f} %", 100.0 * probability);
}

std::string summary_of(const Diagnosis& diagnosis) {
  const VerdictLimits& limits = diagnosis.limits;
  std::string text = verdict_words(diagnosis);
  if (diagnosis.verdict == "none") {
    text = all_of(limits.contradicted) + text;
  } else if (!only_statements_fail(diagnosis)) {
    for (const auto* sentences : {&limits.driving, &limits.contradicted}) {
      for (const std::string& sentence : *sentences) text += " " + sentence;
    }
  }
  return limits.set_aside.empty() ? text : limits.set_aside + " " + text;
}

bool only_statements_fail(const Diagnosis& diagnosis) {
  constexpr double kAtFloor = 5.0;  // standard errors
  const bool explained = diagnosis.gap && diagnosis.gap->before < 1.0 + kAtFloor * diagnosis.gap->standard_error;
  return diagnosis.verdict == "unknown" && explained &&
         !(diagnosis.limits.driving.empty() && diagnosis.limits.contradicted.empty());
}

std::string verdict_by(double none, double unknown) {
  constexpr double kDoubt = 0.25;  // of nothing
  const double named = std::max(0.0, 1.0 - none - unknown);
  if (none >= kDoubt) return "none";
  return named >= unknown ? "effect" : "unknown";
}

}  // namespace glidelab::diagnose
