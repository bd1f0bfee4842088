#include "diagnose/lines/line_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/number_text.h"
#include "base/text/size_text.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/result/verdict_words.h"

namespace glidelab::diagnose {
namespace {

constexpr double kWorthSaying = 0.01;  // probability of what has a name beside something that has none

std::string times(double gap) {
  return gap < 10.0 ? fmt::format("{:.1f}", gap) : fmt::format("{:.0f}", gap);
}

std::string size_text(const LineSize& size) {
  if (size.key == "force_n") return base::size_and_sd_text(size.value, size.sd, "N");
  if (size.key == "mass_kg") return base::size_and_sd_text(size.value, size.sd, "kg");
  return base::size_and_sd_text(size.value, size.sd, "m/s²") + " for each 1/s² of (K/m)²";
}

const LineCandidate& candidate(const LineComparison& lines, const std::string& id) {
  return *std::find_if(lines.candidates.begin(), lines.candidates.end(),
                       [&](const LineCandidate& c) { return c.id == id; });
}

std::string sizes_of(const LineCandidate& candidate) {
  std::string text;
  for (const LineSize& size : candidate.sizes) {
    text += (text.empty() ? "" : " and ") + size_text(size);
  }
  return text;
}

std::string words_of(const Diagnosis& diagnosis, const std::string& id) {
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    if (effect.id == id) return effect.words;
  }
  if (id == ids::load_independent_friction) return "a dry friction that does not depend on the load";
  if (id == ids::smoothing_bias) return "the smoothing's own bias";
  return "inertia that is not in the weighed mass";
}

/// "either of two things, and these lines cannot tell which: A (…), or B (…)".
std::string either(const Diagnosis& diagnosis) {
  const LineComparison& lines = *diagnosis.lines;
  std::string text = lines.either_of.size() == 2 ? "either of two things" : "one of several things";
  text += fmt::format(" ({} together), and these lines cannot tell which: ", percent(lines.either_probability));
  for (std::size_t i = 0; i < lines.either_of.size(); ++i) {
    const LineCandidate& one = candidate(lines, lines.either_of[i]);
    text += fmt::format("{}{} ({}, {}; {})", i == 0 ? "" : ", or ", words_of(diagnosis, one.id), one.id,
                        percent(one.probability), sizes_of(one));
  }
  return text;
}

std::string alike_words(const Diagnosis& diagnosis) {
  std::string text;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    for (const std::string& id : effect.equivalent_to) {
      if (id == ids::eddy_rolloff || id == ids::power_law_drag) text += (text.empty() ? "" : " or ") + id;
    }
  }
  if (text.empty()) return text;
  return fmt::format(" A drag that grows less than in proportion to the speed ({}) has the lines of such a friction.",
                     text);
}

std::string chi2_words(const Diagnosis& diagnosis, const std::string& id) {
  const LineComparison& lines = *diagnosis.lines;
  const LineCandidate &before = candidate(lines, "none"), &after = candidate(lines, id);
  if (!before.chi2 || !after.chi2) return "";
  std::string rivals;
  for (const std::string& other : lines.either_of) {
    if (other == id) continue;
    if (const LineCandidate& rival = candidate(lines, other); rival.chi2) {
      const std::string other_chi2 = base::number_text(*rival.chi2, 3);
      rivals += other_chi2 == base::number_text(*after.chi2, 3) ? " either way" : " or " + other_chi2;
    }
  }
  return fmt::format(
      " Chi² over the lines' own scatter ({} mm/s² of an intercept, {} % of a slope) falls from {} to {}{}.",
      base::number_text(1e3 * lines.intercept_sd_m_s2, 2), base::number_text(1e2 * lines.slope_sd, 2),
      base::number_text(*before.chi2, 3), base::number_text(*after.chi2, 3), rivals);
}

std::string gap_words(const Diagnosis& diagnosis) {
  if (!diagnosis.gap) return " How much one line scatters by itself this table does not tell: no set-up is repeated.";
  const GapSizes& gap = *diagnosis.gap;
  std::string text = fmt::format(
      " Each line predicted by the others is {} times as far off as that scatter explains with the usual model",
      times(gap.before));
  if (diagnosis.verdict == "none") return text + " (1 is the floor).";
  const bool named = diagnosis.verdict == "effect";
  text += fmt::format(", and {} times with {} (1 is the floor).", times(gap.after),
                      !named                                ? "the likeliest difference that has no name"
                      : !diagnosis.lines->either_of.empty() ? "the better of them"
                      : diagnosis.effects.size() > 1        ? "both"
                                                            : "this effect");
  if (named && gap.after > 1.0 + 3.0 * gap.standard_error) {
    text += fmt::format(
        " So even the best explanation with a name leaves {} times the lines' own scatter: something else is missing "
        "as well, or lines of one set-up err together; that something without a name acts has {}.",
        times(gap.after), percent(diagnosis.unknown));
  }
  return text;
}

std::string unknown_words(const Diagnosis& diagnosis) {
  const LineComparison& lines = *diagnosis.lines;
  const auto unnamed = std::find_if(lines.candidates.begin(), lines.candidates.end(),
                                    [](const LineCandidate& c) { return !c.words.empty(); });
  std::string text = fmt::format("Something is missing that no effect with a name explains ({}); likeliest is {}",
                                 percent(diagnosis.unknown), unnamed->words);
  if (unnamed->id != "unknown") text += " beside " + unnamed->id.substr(0, unnamed->id.rfind(" + "));
  text += ".";
  if (!diagnosis.regions.empty()) {
    const GapRegion& most = diagnosis.regions.front();
    text += fmt::format(" Farthest off the usual model, by {} {}, is the {} of {}{}.",
                        base::value_and_sd_text(most.size, most.size_sd.value_or(0.0)), most.unit, most.what,
                        most.variable == "group" ? fmt::format("the set-up at {:.3g} degrees", most.from)
                                                 : fmt::format("{:.0f} g", 1e3 * most.from),
                        most.direction == 0  ? ""
                        : most.direction > 0 ? " where v > 0"
                                             : " where v < 0");
  }
  if (lines.either_of.size() > 1 && lines.either_probability >= kWorthSaying)
    return text + " Of what has a name the best is " + either(diagnosis) + ".";
  return text;
}

}  // namespace

std::string line_summary(const Diagnosis& diagnosis) {
  const LineComparison& lines = *diagnosis.lines;
  if (diagnosis.verdict == "none") {
    const bool doubtful = lines.candidates.front().id != "none";
    return (doubtful
                ? fmt::format("These {} lines leave it open whether anything is missing: that nothing is ({}) is not "
                              "ruled out at three to one, so that no effect is claimed.",
                              lines.lines, percent(diagnosis.none))
                : fmt::format("Nothing is missing that these {} lines could show ({}).", lines.lines,
                              percent(diagnosis.none))) +
           gap_words(diagnosis);
  }
  if (diagnosis.verdict == "unknown") return unknown_words(diagnosis) + gap_words(diagnosis);
  const std::string& id = diagnosis.ranking.front().id;
  if (!lines.either_of.empty()) {
    return fmt::format("These {} lines show {}.{}", lines.lines, either(diagnosis), alike_words(diagnosis)) +
           chi2_words(diagnosis, id) + gap_words(diagnosis);
  }
  std::string named;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    named += fmt::format("{}{} ({}, {})", named.empty() ? "" : " and ", effect.words, effect.id,
                         percent(effect.probability));
  }
  return fmt::format("These {} lines show {}: {}.{}", lines.lines, named, sizes_of(candidate(lines, id)),
                     alike_words(diagnosis)) +
         chi2_words(diagnosis, id) + gap_words(diagnosis);
}

std::string next_for_lines(const std::vector<TableLine>& lines, double force_n, double bias_s2_m_s2) {
  double drag = 0.0;
  for (const TableLine& line : lines) drag += line.k_over_m_1_s * line.mass_kg / static_cast<double>(lines.size());
  const double heavy = 3.0 * different(lines, &TableLine::mass_kg).back();
  return fmt::format(
      "Analyse the same clips with half and with twice the kernel's width: a smoothing bias changes with its square, a "
      "friction force does not change. Or record a glider of {:.0f} g both ways: a friction force of {} moves "
      "its intercepts by {} each, the smoothing bias by {}.",
      1000.0 * heavy, base::size_text(force_n, 2, "N"), base::size_text(force_n / heavy, 2, "m/s²"),
      base::size_text(bias_s2_m_s2 * (drag / heavy) * (drag / heavy), 2, "m/s²"));
}

}  // namespace glidelab::diagnose
