#include "report/diagnosis/line_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/number_text.h"
#include "base/text/size_text.h"
#include "diagnose/effects/effect_library.h"
#include "report/diagnosis/explanation_text.h"

namespace glidelab::report {
namespace {

constexpr double kWorthSaying = 0.01;  // probability of what has a name beside something that has none

std::string line_times(double gap) {
  return gap < 10.0 ? fmt::format("{:.1f}", gap) : fmt::format("{:.0f}", gap);
}

std::string line_size_text(const diagnose::LineSize& size) {
  if (size.key == "force_n") return base::size_and_sd_text(size.value, size.sd, "N");
  if (size.key == "mass_kg") return base::size_and_sd_text(size.value, size.sd, "kg");
  return base::size_and_sd_text(size.value, size.sd, "m/s²") + " for each 1/s² of (K/m)²";
}

const diagnose::LineCandidate& candidate(const diagnose::LineComparison& lines,
                                         const diagnose::Explanation& explanation) {
  return *std::find_if(lines.candidates.begin(), lines.candidates.end(),
                       [&](const diagnose::LineCandidate& c) { return c.explanation == explanation; });
}

/// Of one effect alone.
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

std::string words_of(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    if (effect.id == id) return effect.words;
  }
  return std::string(diagnose::effect_of(id).words);
}

/// "either of two things, and these lines cannot tell which: A (…), or B (…)".
std::string either(const diagnose::Diagnosis& diagnosis) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  std::string text = lines.either_of.size() == 2 ? "either of two things" : "one of several things";
  text += fmt::format(" ({} together), and these lines cannot tell which: ", percent(lines.either_probability));
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
      if (id == diagnose::ids::eddy_rolloff || id == diagnose::ids::power_law_drag)
        text += (text.empty() ? "" : " or ") + id;
    }
  }
  if (text.empty()) return text;
  return fmt::format(
      " A drag that grows less than proportionally to the speed ({}) has the same lines as such a friction.", text);
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
  if (!diagnosis.gap) return " This table does not tell how much one line scatters by itself: no set-up is repeated.";
  const diagnose::GapSizes& gap = *diagnosis.gap;
  std::string text = fmt::format(
      " Predicted by the others with the nominal model, each line is {} times as far off as that scatter explains",
      line_times(gap.before));
  if (diagnosis.verdict == diagnose::Verdict::none) return text + " (1 is the floor).";
  const bool named = diagnosis.verdict == diagnose::Verdict::effect;
  text += fmt::format(", and {} times with {} (1 is the floor).", line_times(gap.after),
                      !named                                ? "the likeliest difference that has no name"
                      : !diagnosis.lines->either_of.empty() ? "the better of them"
                      : diagnosis.effects.size() > 1        ? "both"
                                                            : "this effect");
  if (named && gap.after > 1.0 + 3.0 * gap.standard_error) {
    text += fmt::format(
        " So even the best explanation with a name leaves {} times the lines' own scatter: something else is missing "
        "as well, or lines of one set-up err together. The probability that something without a name acts is {}.",
        line_times(gap.after), percent(diagnosis.unknown));
  }
  return text;
}

std::string unknown_words(const diagnose::Diagnosis& diagnosis) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  const auto unnamed = std::find_if(lines.candidates.begin(), lines.candidates.end(),
                                    [](const diagnose::LineCandidate& c) { return c.unnamed.has_value(); });
  std::string text = fmt::format("Something is missing that no effect with a name explains ({}). The likeliest is {}",
                                 percent(diagnosis.unknown), unnamed_words(*unnamed->unnamed));
  if (!unnamed->explanation.effects.empty()) {
    text += " beside " + explanation_id({unnamed->explanation.effects, false});
  }
  text += ".";
  if (!diagnosis.regions.empty()) {
    const diagnose::GapRegion& most = diagnosis.regions.front();
    text += fmt::format(" Farthest off the nominal model, by {} {}, is the {} of {}{}.",
                        base::value_and_sd_text(most.size, most.size_sd.value_or(0.0)), most.unit, most.what,
                        most.variable == "group" ? fmt::format("the set-up at {:.3g} degrees", most.from)
                                                 : fmt::format("{:.0f} g", 1e3 * most.from),
                        most.direction == 0  ? ""
                        : most.direction > 0 ? " where v > 0"
                                             : " where v < 0");
  }
  if (lines.either_of.size() > 1 && lines.either_probability >= kWorthSaying)
    return text + " The best explanation with a name is " + either(diagnosis) + ".";
  return text;
}

}  // namespace

std::string line_words(const diagnose::Diagnosis& diagnosis) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  if (diagnosis.verdict == diagnose::Verdict::none) {
    const bool doubtful = !lines.candidates.front().explanation.is_nothing();
    return (doubtful
                ? fmt::format("These {} lines leave it open whether anything is missing: nothing missing ({}) is not "
                              "ruled out at three to one, so no effect is claimed.",
                              lines.lines, percent(diagnosis.none))
                : fmt::format("Nothing is missing that these {} lines could show ({}).", lines.lines,
                              percent(diagnosis.none))) +
           line_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown) return unknown_words(diagnosis) + line_gap_words(diagnosis);
  const diagnose::Explanation& named_first = diagnosis.ranking.front().explanation;
  if (!lines.either_of.empty()) {
    return fmt::format("These {} lines show {}.{}", lines.lines, either(diagnosis), alike_words(diagnosis)) +
           chi2_words(diagnosis, named_first) + line_gap_words(diagnosis);
  }
  std::string named;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    named += fmt::format("{}{} ({}, {})", named.empty() ? "" : " and ", effect.words, effect.id,
                         percent(effect.probability));
  }
  return fmt::format("These {} lines show {}: {}.{}", lines.lines, named, sizes_of(candidate(lines, named_first)),
                     alike_words(diagnosis)) +
         chi2_words(diagnosis, named_first) + line_gap_words(diagnosis);
}

std::string unnamed_words(const diagnose::UnnamedInLines& of) {
  using Over = diagnose::UnnamedInLines::Over;
  const char* what = of.what == diagnose::UnnamedInLines::What::friction ? "friction" : "drag";
  switch (of.over) {
    case Over::mass:
      return fmt::format("a separate {} for each mass", what);
    case Over::set_up:
      return fmt::format("a separate {} for each set-up", what);
    case Over::mass_and_set_up:
      return fmt::format("a separate {} for each mass in each set-up", what);
    case Over::direction:
      return fmt::format("a separate {} for each direction", what);
  }
  return {};
}

std::string impossible_words(const diagnose::ImpossibleSize& size) {
  const auto [name, unit] = base::name_and_unit(size.key);
  const std::string needed = fmt::format("{} would have to be {}", name, base::size_text(size.value, 2, unit));
  if (!size.largest) return needed + ", and it cannot be below zero";
  return fmt::format("{}, and more than {} is implausible", needed, base::size_text(*size.largest, 2, unit));
}

}  // namespace glidelab::report
