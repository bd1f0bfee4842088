#include "diagnose/verdict_words.h"

#include <fmt/format.h>

#include <algorithm>

namespace glidelab::diagnose {
namespace {

std::string times(double gap) {
  return gap < 10.0 ? fmt::format("{:.2f}", gap) : fmt::format("{:.0f}", gap);
}

std::string percent(double probability) {
  if (probability > 0.995) return "more than 99 %";
  if (probability < 0.005) return "less than 1 %";
  return fmt::format("{:.0f} %", 100.0 * probability);
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " and " : ", ") + words[i];
  }
  return text;
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
    text += fmt::format("; with {} in the model it is {} times (1 is the floor)",
                        diagnosis.effects.size() > 1 ? "these effects" : "this effect", times(gap.after));
  }
  if (diagnosis.verdict == "unknown" && gap.shrink && gap.after < gap.before) {
    text += fmt::format(
        "; with a free curve that all clips share, learnt from the other clips, it is {} times (1 is the floor)",
        times(gap.after));
  }
  return text + ".";
}

}  // namespace

std::string summary_of(const Diagnosis& diagnosis) {
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
            ": {}. How large it is these data do not tell: the estimate, {:.2g} {}, is far more than the usual model "
            "lacks anywhere ({:.2g} {}).",
            region.what, region.size, region.unit, *region.lacking, region.unit);
      } else {
        text += fmt::format(": {} of up to {:.2g} {}.", region.what, region.size, region.unit);
      }
    }
    return text + gap_words(diagnosis);
  }
  std::vector<std::string> words;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    words.push_back(fmt::format("{} ({}, {})", effect.words, effect.id, percent(effect.probability)));
  }
  std::string text = fmt::format("The data show {}.", list_of(words));
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    if (effect.equivalent_to.empty()) continue;
    text += fmt::format(" They cannot tell {} from {}: any of these would look the same.", effect.id,
                        list_of(effect.equivalent_to));
  }
  return text + gap_words(diagnosis);
}

std::string verdict_by(double none, double unknown) {
  constexpr double kDoubt = 0.25;  // of nothing
  const double named = std::max(0.0, 1.0 - none - unknown);
  if (none >= kDoubt) return "none";
  return named >= unknown ? "effect" : "unknown";
}

}  // namespace glidelab::diagnose
