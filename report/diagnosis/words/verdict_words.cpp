#include "report/diagnosis/words/verdict_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <variant>

#include "base/text/number_text.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/effects/effect_list.h"
#include "report/check/finding_words.h"
#include "report/diagnosis/words/cause_words.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/diagnosis/words/line_words.h"
#include "report/diagnosis/words/next_step_words.h"
#include "report/html/html.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

std::string times(double gap) {
  return gap < 10.0 ? fmt::format("{:.2f}", gap) : fmt::format("{:.0f}", gap);
}

std::string count_in_words(std::size_t count) {
  static const std::array<const char*, 9> kWords = {"two",   "three", "four", "five", "six",
                                                    "seven", "eight", "nine", "ten"};
  return count >= 2 && count - 2 < kWords.size() ? kWords[count - 2] : fmt::format("{}", count);
}

/// One effect, or, before any of its members, the set that these data cannot distinguish.
std::string claim(const diagnose::DiagnosedEffect& effect) {
  const std::vector<diagnose::AlikeEffect> alike = told_alike(effect);
  if (alike.empty()) {
    return fmt::format("{} ({}, {})", effect.words, effect.id, percent(effect.probability));
  }
  // A member that has nearly all of it is the answer.
  constexpr double kNearlyAll = 0.9;
  if (effect.probability >= kNearlyAll * effect.joint_probability) {
    return fmt::format("{} ({}, {}; {} together with what these data cannot distinguish from it)", effect.words,
                       effect.id, percent(effect.probability), percent(effect.joint_probability));
  }
  constexpr std::size_t kMostMembers = 5;  // more are a list that nobody reads
  const std::size_t named = alike.size() > kMostMembers + 1 ? kMostMembers : alike.size();
  std::vector<std::string> members;
  for (const diagnose::AlikeEffect& one : std::span(alike).first(named)) {
    members.push_back(one.probability ? fmt::format("{} ({}, {})", one.words, one.id, percent(*one.probability))
                                      : fmt::format("{} ({})", one.words, one.id));
  }
  if (named < alike.size()) members.push_back(fmt::format("one of {} others", count_in_words(alike.size() - named)));
  return fmt::format("one of these {} ({} together), but cannot tell which: {}", count_in_words(alike.size()),
                     percent(effect.joint_probability), list_of(members, ", or "));
}

std::string_view in_words(diagnose::GapVariable variable) {
  switch (variable) {
    case diagnose::GapVariable::acceleration:
      return "the acceleration";
    case diagnose::GapVariable::clip:
      return "the clip";
    case diagnose::GapVariable::direction:
      return "the direction";
    case diagnose::GapVariable::set_up:
      return "the set-up";
    case diagnose::GapVariable::mass:
      return "the mass";
    case diagnose::GapVariable::time:
      return "the time";
    case diagnose::GapVariable::column:
      return "the image column";
    case diagnose::GapVariable::speed:
      return "the speed";
    case diagnose::GapVariable::row:
      return "the image row";
    case diagnose::GapVariable::position:
      return "the position on the track";
  }
  return {};
}

/// `sequence`: the remainder with the causes in the model has already been stated.
std::string clip_gap_words(const diagnose::Diagnosis& diagnosis, bool sequence = false) {
  if (!diagnosis.gap) return "";
  const diagnose::GapSizes& gap = *diagnosis.gap;
  std::string text =
      fmt::format(" Held-out clips lie {} times as far from {} as their noise explains", times(gap.before),
                  is_measured_without_drag(diagnosis)
                      ? "a fall without any drag"
                      : "the nominal model (drag proportional to the speed, dry friction, gravity)");
  if (sequence) return text + ".";
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
        "; with a free-form curve common to all clips, fitted to the other clips, {} times (1 is the floor)",
        times(gap.after));
  }
  return text + ".";
}

/// The sentences of all notes, in a row.
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
    return fmt::format("{} Small residuals therefore do not mean that the model is complete ({}).",
                       sentences(diagnosis.limits.driving), sure);
  }
  return fmt::format(
      "{} The nominal model explains the motion to within its noise: a stated angle, length or frame rate is wrong, or "
      "something acts like an inclination ({}).",
      sentences(diagnosis.limits.contradicted), sure);
}

/// After a verdict: the first set-up, and the number of others; each has its note.
std::string contradicted_words(const diagnose::Diagnosis& diagnosis) {
  const std::vector<diagnose::ContradictedIncline>& all = diagnosis.limits.contradicted;
  std::string text = note_words(as_told(all.front(), diagnosis));
  if (all.size() > 1) {
    text += fmt::format(" The motion also contradicts what is stated of {} more set-up{}.", all.size() - 1,
                        all.size() > 2 ? "s" : "");
  }
  return text;
}

/// The variable on which the gap depends most, and its size there.
std::string first_region_words(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.regions.empty()) return "";
  const diagnose::GapRegion& region = diagnosis.regions.front();
  std::string text = fmt::format(" The remainder depends most on {}", in_words(region.variable));
  if (!region.clip.empty()) text += " and is largest in clip " + region.clip;
  if (region.lacking) {
    return text + fmt::format(
                      ": {}. Its size cannot be determined from these data: the estimate, {}, far exceeds the largest "
                      "residual of the nominal model ({}).",
                      to_text(region.what), base::size_text(region.size, 2, region.unit),
                      base::size_text(*region.lacking, 2, region.unit));
  }
  return text + fmt::format(": {} of up to {}.", to_text(region.what), largest_words(region));
}

/// After the sentence about the causes: how certain they are, and for `unknown` where the remainder lies.
std::string beside_sequence(const diagnose::Diagnosis& diagnosis) {
  std::string text;
  if (diagnosis.verdict == diagnose::Verdict::effect) {
    const std::string sure = sureness_words(diagnosis);
    if (!sure.empty()) text = " " + sure;
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown) {
    const std::string clearest = diagnosis.remainder ? clearest_words(*diagnosis.remainder) : "";
    text = clearest.empty() ? first_region_words(diagnosis) : " " + clearest;
  }
  return text + clip_gap_words(diagnosis, true);
}

/// Whether an explanation that is more than the traces, which change nothing, is likelier than nothing.
bool is_uncertain(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.ranking.empty() || diagnosis.ranking.front().probability <= diagnosis.none) return false;
  const std::vector<std::string>& ids = diagnosis.ranking.front().explanation.effects;
  return !std::all_of(ids.begin(), ids.end(), [&](const std::string& id) {
    return std::find(diagnosis.traces.begin(), diagnosis.traces.end(), id) != diagnosis.traces.end();
  });
}

/// "the nominal model explains them to within their noise"
std::string floor_words(const diagnose::Diagnosis& diagnosis, const std::string& of) {
  return leaves_noise_alone(diagnosis)
             ? "the nominal model explains " + of + " to within their noise"
             : "what the nominal model leaves of " + of + " is more than their noise, but not clearly";
}

std::string clip_verdict(const diagnose::Diagnosis& diagnosis) {
  if (only_statements_fail(diagnosis)) {
    return wrongly_stated_words(diagnosis) + clip_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::none && is_uncertain(diagnosis)) {
    return fmt::format(
               "It is uncertain whether anything is missing. The likeliest explanation is {} ({}), but “nothing "
               "missing” ({}) cannot be excluded at odds of 3 to 1, so no effect is claimed.",
               explanation_name(diagnosis.ranking.front().explanation), percent(diagnosis.ranking.front().probability),
               percent(diagnosis.none)) +
           clip_gap_words(diagnosis);
  }
  if (const std::string sequence = sequence_words(diagnosis); !sequence.empty()) {
    return sequence + beside_sequence(diagnosis);
  }
  constexpr double kRather = 0.5;  // the probability from which nothing is rather missing than something
  if (diagnosis.verdict == diagnose::Verdict::none && diagnosis.none < kRather && !diagnosis.ranking.empty()) {
    return fmt::format(
               "{}. They cannot exclude other causes, but no known effect is as likely as nothing being missing ({}); "
               "the likeliest is {} ({}).",
               capital(floor_words(diagnosis, "these data")), percent(diagnosis.none),
               explanation_name(diagnosis.ranking.front().explanation),
               percent(diagnosis.ranking.front().probability)) +
           clip_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::none) {
    return fmt::format("As far as these data can show, nothing is missing ({}): {}.", percent(diagnosis.none),
                       floor_words(diagnosis, "them")) +
           clip_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown && is_at_floor(diagnosis) && diagnosis.limits.set_aside &&
      diagnosis.limits.set_aside->is_large()) {
    return "Whether anything is missing is not known: the other positions alone do not show it." +
           clip_gap_words(diagnosis);
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown) {
    return fmt::format("Something is missing, and it is none of the known effects ({}).", percent(diagnosis.unknown)) +
           first_region_words(diagnosis) + clip_gap_words(diagnosis);
  }
  std::vector<std::string> words;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) words.push_back(claim(effect));
  std::string text = fmt::format("The data show {}.", list_of(words));
  return text + clip_gap_words(diagnosis);
}

/// A unit that may be wrong, a scale, or a fall that is too slow.
std::string doubtful_unit_words(const diagnose::DoubtfulUnit& of) {
  const FindingWords words = finding_words(of.found);
  if (std::holds_alternative<core::found::FallsSlowly>(of.found)) {
    return fmt::format(
        "First find out why it falls so slowly ({}: {}). {} Otherwise nothing below holds.", of.clip, words.found,
        of.weight_open
            ? "The force that drives it is therefore fitted. If it was at its final speed from the start, terminal "
              "velocities hold; if a liquid bears part of its weight, K/m holds as well."
            : "If it was at its final speed from the start, terminal velocities hold. If a liquid bears part of its "
              "weight, they hold as well, and drags are too large by the ratio of its weight to that in the liquid.");
  }
  const bool scale = std::holds_alternative<core::found::FallAboveGravity>(of.found);
  return fmt::format("First {} ({}: {}). {}.", words.advice, of.clip, words.found,
                     scale ? "Drag and friction cannot explain that" : "In another unit, nothing below holds");
}

/// A path that turns by less hardly changes gravity along it.
std::string bent_path_words(const diagnose::OfReading& of) {
  constexpr double kClearly_deg = 3.0;
  const auto* const path = std::get_if<core::PathBends>(&of.note);
  if (path == nullptr || path->slope_deg < kClearly_deg) return {};
  return fmt::format(
      "First find out whether the track is straight: in {}, the direction of the path in x and y changes by {:.1f}°. "
      "On a bent track gravity along the motion changes, and the causes named below may be an effect of that.",
      of.clip, path->slope_deg);
}

/// What has to be checked before a diagnosis can be trusted: of the clips that make a unit of lengths or times, or the
/// scale, doubtful, the first; otherwise of those whose path turns by three degrees or more. Empty if there are none.
std::string check_first_words(const diagnose::Diagnosis& diagnosis) {
  for (const diagnose::Note& note : diagnosis.notes) {
    if (const auto* const of = std::get_if<diagnose::DoubtfulUnit>(&note)) return doubtful_unit_words(*of);
  }
  for (const diagnose::Note& note : diagnosis.notes) {
    if (const auto* const of = std::get_if<diagnose::OfReading>(&note)) {
      if (std::string words = bent_path_words(*of); !words.empty()) return words;
    }
  }
  return {};
}

/// That the images show the camera to drift along the motion; empty if they do not, or if its motion is named.
std::string drift_words(const diagnose::Diagnosis& diagnosis) {
  const auto names_it = [](const diagnose::DiagnosedEffect& effect) {
    return effect.id == diagnose::ids::camera_motion ||
           std::ranges::count(effect.equivalent_to, diagnose::ids::camera_motion) > 0;
  };
  if (std::ranges::any_of(diagnosis.effects, names_it)) return {};
  for (const diagnose::ImageFinding& finding : diagnosis.images) {
    const auto* const sway = std::get_if<diagnose::image::Sway>(&finding.fact);
    if (sway == nullptr || sway->how != diagnose::image::Sway::How::drifts || !(sway->speed_m_s > 0.0)) continue;
    return fmt::format(
        " The camera drifts: the images show up to {:.2g} mm/s along the track, by which every speed may be wrong. The "
        "uncertainties of α and of the terminal velocity include it; fix the camera before you film again.",
        1e3 * sway->speed_m_s);
  }
  return {};
}

}  // namespace

std::string verdict_words(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.lines) return line_words(diagnosis);
  const diagnose::VerdictLimits& limits = diagnosis.limits;
  std::string text = clip_verdict(diagnosis);
  if (diagnosis.verdict == diagnose::Verdict::none) {
    if (!limits.contradicted.empty()) text = sentences(limits.contradicted) + " " + text;
  } else if (is_at_floor(diagnosis) && !limits.resolved.empty()) {
    text = sentences(limits.resolved) + " If that statement is wrong, a cause named below may only make up for it. " +
           text;
  } else if (!only_statements_fail(diagnosis)) {
    if (!limits.driving.empty()) text += " " + sentences(limits.driving);
    if (!limits.contradicted.empty()) text += " " + contradicted_words(diagnosis);
  }
  text += drift_words(diagnosis);
  if (limits.set_aside) text = note_words(*limits.set_aside) + " " + text;
  const std::string first = check_first_words(diagnosis);
  return first.empty() ? text : first + " " + text;
}

std::string too_few_words(const diagnose::GapIntervals& intervals) {
  if (!intervals.too_few) return {};
  return fmt::format("{} clip{} cannot show how much clips differ: an interval needs three or more", *intervals.too_few,
                     *intervals.too_few == 1 ? "" : "s");
}

namespace {

/// The consequence of the verdict for K/m, µ and the inclination from an analysis of the same data; empty if they may
/// be trusted, or if the question is open.
std::string consequence(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.verdict == diagnose::Verdict::effect) {
    const bool lost_only = diagnosis.effects.size() == 1 &&
                           diagnosis.effects.front().id == diagnose::ids::dropped_frames &&
                           diagnosis.effects.front().equivalent_to.empty();
    if (lost_only)
      return " An analysis of these data reports the losses that it finds, and corrects the times after them.";
    const char* const below = diagnosis.recovered.empty() ? "" : " The table below includes it.";
    return std::string(
               " glidelab analyze leaves this out: its K/m, µ and inclination are those of "
               "a law without it, and may be wrong by more than their ± says.") +
           below;
  }
  if (diagnosis.verdict == diagnose::Verdict::unknown) {
    return " Until the cause is found, K/m, µ and the inclination from an analysis of these data are fit parameters; "
           "they need not be properties of the track or the glider.";
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
  std::string text = tile(probability_text(diagnosis.none), "nothing is missing");
  // A difference between lines always has a name.
  if (!diagnosis.lines) text += tile(probability_text(diagnosis.unknown), "an unnamed cause");
  if (!diagnosis.gap) return text;
  const std::string before = base::number_text(diagnosis.gap->before, 3);
  return text +
         tile(one_model(diagnosis) ? before : before + " → " + base::number_text(diagnosis.gap->after, 3), gap_words);
}

std::string diagnosis_meaning(const diagnose::Diagnosis& diagnosis) {
  // The answer is highlighted if it has its own sentence.
  std::string verdict = escape(verdict_words(diagnosis));
  const std::string lead = diagnosis.lines ? std::string() : escape(sequence_words(diagnosis));
  if (const std::size_t at = verdict.find(lead); !lead.empty() && at != std::string::npos) {
    verdict = fmt::format("{}<b>{}</b>{}", verdict.substr(0, at), lead, verdict.substr(at + lead.size()));
  }
  return meaning_section(fmt::format("<p>{}{}</p>\n", verdict, consequence(diagnosis)));
}

std::string next_step_note(const diagnose::Diagnosis& diagnosis) {
  return fmt::format("<p class=\"note\"><b>What to record next.</b> {}</p>\n", escape(next_step_words(diagnosis.next)));
}

std::string note_paragraphs(const diagnose::Diagnosis& diagnosis) {
  std::string text;
  for (const std::string& note : notes_words(diagnosis)) {
    text += fmt::format("<p class=\"soft\">{}</p>\n", escape(note));
  }
  return text;
}

}  // namespace glidelab::report
