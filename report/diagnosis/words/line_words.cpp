#include "report/diagnosis/words/line_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/text/number_text.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/effects/effect_list.h"
#include "report/diagnosis/words/cause_words.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

std::string line_times(double gap) {
  return gap < 10.0 ? fmt::format("{:.1f}", gap) : fmt::format("{:.0f}", gap);
}

std::string line_size_text(const diagnose::LineSize& size) {
  if (size.key == "force_n") return base::size_and_sd_text(size.value, size.sd, "N");
  if (size.key == "mass_kg") return base::size_and_sd_text(size.value, size.sd, "kg");
  if (size.key == "d") return "d = " + base::value_and_sd_text(size.value, size.sd) + " in K (1 + d sign(v))";
  if (size.key == "sd") return "µ differs by " + base::value_and_sd_text(size.value, size.sd) + " (standard deviation)";
  if (size.key == "sd_n_s_m")
    return "K differs by " + base::value_and_sd_text(size.value, size.sd) + " N s/m (standard deviation)";
  return base::size_and_sd_text(size.value, size.sd, "m/s²") + " for each 1/s² of (K/m)²";
}

/// The likeliest candidate with these effects, in whatever order.
const diagnose::LineCandidate& candidate(const diagnose::LineComparison& lines,
                                         const diagnose::Explanation& explanation) {
  const auto sorted = [](std::vector<std::string> effects) {
    std::sort(effects.begin(), effects.end());
    return effects;
  };
  const std::vector<std::string> effects = sorted(explanation.effects);
  return *std::find_if(lines.candidates.begin(), lines.candidates.end(),
                       [&](const diagnose::LineCandidate& c) { return sorted(c.explanation.effects) == effects; });
}

/// An explanation with one effect only.
diagnose::Explanation only(const std::string& id) {
  return {{id}, false};
}

std::string sizes_of(const diagnose::LineCandidate& candidate) {
  std::string text;
  for (const diagnose::LineSize& size : candidate.sizes) {
    text += (text.empty() ? "" : " and ") + line_size_text(size);
  }
  return text;
}

/// "µ from 0.0051 (535 g, 0°) to 0.0075 (335 g, 0°)", for an effect with a size for each cell; otherwise its single
/// size.
std::string effect_size_text(const diagnose::DiagnosedEffect& effect) {
  constexpr std::string_view kMuOf = "mu.", kDragOf = "k_n_s_m.";
  const diagnose::DiagnosedParameter *least = nullptr, *most = nullptr;
  for (const diagnose::DiagnosedParameter& one : effect.parameters) {
    if (!one.key.starts_with(kMuOf) && !one.key.starts_with(kDragOf)) continue;
    if (least == nullptr || one.value < least->value) least = &one;
    if (most == nullptr || one.value > most->value) most = &one;
  }
  if (least == nullptr) {
    const diagnose::DiagnosedParameter& size = effect.parameters.front();
    return line_size_text({size.key, size.value, size.sd});
  }
  const bool drag = least->key.starts_with(kDragOf);
  const auto one = [&](const diagnose::DiagnosedParameter& of) {
    return fmt::format("{}{} ({})", base::value_and_sd_text(of.value, of.sd), drag ? " N s/m" : "",
                       of.key.substr((drag ? kDragOf : kMuOf).size()));
  };
  return fmt::format("{} from {} to {}", drag ? "K" : "µ", one(*least), one(*most));
}

std::string words_of(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    if (effect.id == id) return effect.words;
  }
  return std::string(diagnose::effect_of(id).words);
}

/// "either of two things (55 % together) that these lines cannot distinguish: A (…), or B (…)".
std::string either(const diagnose::Diagnosis& diagnosis) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  std::string text = lines.either_of.size() == 2 ? "one of two effects" : "one of several effects";
  text += fmt::format(" ({} together) that these lines cannot distinguish: ", percent(lines.either_probability));
  for (std::size_t i = 0; i < lines.either_of.size(); ++i) {
    const diagnose::LineCandidate& one = candidate(lines, only(lines.either_of[i]));
    text += fmt::format("{}{} ({}, {}; {})", i == 0 ? "" : ", or ", words_of(diagnosis, lines.either_of[i]),
                        lines.either_of[i], percent(one.probability), sizes_of(one));
  }
  return text;
}

std::string alike_words(const diagnose::Diagnosis& diagnosis) {
  std::string text;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const std::string& id : effect.equivalent_to) {
      const diagnose::EffectInfo* const info = diagnose::find_effect(id);
      if (info != nullptr && !info->lines.same_as.empty()) text += (text.empty() ? "" : " or ") + id;
    }
  }
  if (text.empty()) return text;
  return fmt::format(
      " A drag that grows less than in proportion to the speed ({}) gives the same lines as such a friction force.",
      text);
}

std::string chi2_words(const diagnose::Diagnosis& diagnosis, const diagnose::Explanation& named) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  const diagnose::LineCandidate &before = candidate(lines, {}), &after = candidate(lines, named);
  if (!before.chi2 || !after.chi2) return "";
  std::string rivals;
  for (const std::string& other : lines.either_of) {
    if (only(other) == named) continue;
    if (const diagnose::LineCandidate& rival = candidate(lines, only(other)); rival.chi2) {
      const std::string other_chi2 = base::number_text(*rival.chi2, 3);
      rivals += other_chi2 == base::number_text(*after.chi2, 3) ? " either way" : " or " + other_chi2;
    }
  }
  return fmt::format(
      " Chi² over the lines' own scatter ({} mm/s² of an intercept, {} % of a slope) falls from {} to {}{}.",
      base::number_text(1e3 * lines.intercept_sd_m_s2, 2), base::number_text(1e2 * lines.slope_sd, 2),
      base::number_text(*before.chi2, 3), base::number_text(*after.chi2, 3), rivals);
}

std::string line_gap_words(const diagnose::Diagnosis& diagnosis) {
  if (!diagnosis.gap) return " No set-up is repeated, so the scatter of a single line is unknown.";
  const diagnose::GapSizes& gap = *diagnosis.gap;
  std::string text = fmt::format(
      " Predicted from the others with the nominal model, each line is off by {} times what that scatter explains",
      line_times(gap.before));
  if (diagnosis.verdict == diagnose::Verdict::none) return text + " (1 is the floor).";
  text += fmt::format(", and {} times with {} (1 is the floor).", line_times(gap.after),
                      !diagnosis.lines->either_of.empty() ? "the better of them"
                      : diagnosis.effects.size() > 1      ? "both"
                                                          : "this effect");
  if (gap.before < 1.0) {
    text +=
        " On average no line is off by more than its scatter: the evidence for a cause is in the pattern of the "
        "deviations.";
  }
  if (gap.after > 1.0 + diagnose::kClearGap * gap.standard_error) {
    text += fmt::format(
        " Even the best explanation leaves {} times the lines' own scatter: something else is missing as well, or "
        "errors within one set-up are correlated.",
        line_times(gap.after));
  }
  return text;
}

/// Causes that take less than a hundredth of the gap.
std::string line_traces_words(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.traces.empty()) return "";
  return fmt::format(" Also detected, but with less than 1 % of the gap: {}.", list_of(effect_names(diagnosis.traces)));
}

}  // namespace

std::string line_words(const diagnose::Diagnosis& diagnosis) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  if (diagnosis.verdict == diagnose::Verdict::none) {
    const bool doubtful = !lines.candidates.front().explanation.is_nothing();
    return (doubtful ? fmt::format(
                           "These {} lines do not decide whether anything is missing: \"nothing missing\" ({}) cannot "
                           "be excluded at odds of 3 to 1, so no effect is claimed.",
                           lines.lines, percent(diagnosis.none))
                     : fmt::format("As far as these {} lines can show, nothing is missing ({}).", lines.lines,
                                   percent(diagnosis.none))) +
           line_gap_words(diagnosis);
  }
  diagnose::Explanation named_all;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) named_all.effects.push_back(effect.id);
  const std::string within = holds_within_words(diagnosis);
  const std::string first = within.empty() ? "" : within + " ";
  if (!lines.either_of.empty()) {
    return first + fmt::format("These {} lines show {}.{}", lines.lines, either(diagnosis), alike_words(diagnosis)) +
           chi2_words(diagnosis, named_all) + line_gap_words(diagnosis);
  }
  std::string named, sizes;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    sizes += (sizes.empty() ? "" : " and ") + effect_size_text(effect);
    named += fmt::format("{}{} ({}, {})", named.empty() ? "" : " and ", effect.words, effect.id,
                         percent(effect.probability));
  }
  return first + fmt::format("These {} lines show {}: {}.{}", lines.lines, named, sizes, alike_words(diagnosis)) +
         chi2_words(diagnosis, named_all) + line_gap_words(diagnosis) + line_traces_words(diagnosis);
}

std::string form_words(const diagnose::LineForm& form) {
  const diagnose::EffectInfo* const effect = diagnose::find_effect(form.id);
  const char* what = effect != nullptr && effect->lines.own == diagnose::OwnOfLines::drag ? "K" : "µ";
  switch (form.over) {
    case diagnose::LinesOver::mass:
      return fmt::format("a separate {} for each mass", what);
    case diagnose::LinesOver::set_up:
      return fmt::format("a separate {} for each set-up", what);
    case diagnose::LinesOver::mass_and_set_up:
      return fmt::format("a separate {} for each mass in each set-up", what);
  }
  return {};
}

std::string forms_words(const diagnose::LineCandidate& candidate) {
  std::string text;
  for (const diagnose::LineForm& form : candidate.forms) text += (text.empty() ? "" : ", ") + form_words(form);
  return text;
}

std::string impossible_words(const diagnose::ImpossibleSize& size) {
  const auto [name, unit] = base::name_and_unit(size.key);
  const std::string needed = fmt::format("{} would have to be {}", name, base::size_text(size.value, 2, unit));
  if (!size.largest) return needed + ", and it cannot be below zero";
  return fmt::format("{}, and more than {} is implausible", needed, base::size_text(*size.largest, 2, unit));
}

}  // namespace glidelab::report
