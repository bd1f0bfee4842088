#include "report/diagnosis/words/diagnosis_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/math/angles.h"
#include "base/text/number_text.h"
#include "diagnose/effects/effect_list.h"
#include "diagnose/result/joined_ids.h"
#include "report/analysis/note_words.h"
#include "report/analysis/statement_words.h"
#include "report/check/finding_words.h"
#include "report/html/html.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

std::vector<std::string> ids_of(const diagnose::Explanation& explanation) {
  std::vector<std::string> ids = explanation.effects;
  if (explanation.unnamed) ids.emplace_back("unknown");
  if (ids.empty()) ids.emplace_back("none");
  return ids;
}

}  // namespace

std::string explanation_id(const diagnose::Explanation& explanation) {
  return diagnose::joined_ids(ids_of(explanation));
}

std::string explanation_name(const diagnose::Explanation& explanation) {
  return fmt::format("{}", fmt::join(effect_names(ids_of(explanation)), " + "));
}

std::string explanation_html(const diagnose::Explanation& explanation) {
  const std::string name = explanation_name(explanation), id = explanation_id(explanation);
  if (name == id) return escape(id);
  return fmt::format("{} <small><code>{}</code></small>", escape(name), escape(id));
}

namespace {

constexpr double kLeastPercent = 0.005;  // a smaller probability is told as less than 1 %

}  // namespace

std::string percent(double probability) {
  if (probability > 1.0 - kLeastPercent) return "more than 99 %";
  if (probability < kLeastPercent) return "less than 1 %";
  return fmt::format("{:.0f} %", 100.0 * probability);
}

std::vector<diagnose::AlikeEffect> told_alike(const diagnose::DiagnosedEffect& effect) {
  constexpr double kPartOfLikeliest = 0.05;
  std::vector<diagnose::AlikeEffect> told = effect.alike;
  double likeliest = 0.0;
  for (const diagnose::AlikeEffect& one : told) likeliest = std::max(likeliest, one.probability.value_or(0.0));
  const double least = std::max(kLeastPercent, kPartOfLikeliest * likeliest);
  std::erase_if(told, [&](const diagnose::AlikeEffect& one) {
    return one.id != effect.id && one.probability && *one.probability < least;
  });
  if (told.size() < 2) told.clear();
  return told;
}

namespace {

/// Decimals of a value to the first digit of its standard deviation, at least two.
int decimals_for(double sd) {
  return sd > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(sd))), 2, 9) : 2;
}

/// `-ups "a", "b"`, or `-up "a"` for one.
std::string ups(const std::vector<std::string>& names) {
  std::string text = names.size() > 1 ? "-ups" : "-up";
  for (std::size_t i = 0; i < names.size(); ++i) text += fmt::format("{} \"{}\"", i == 0 ? "" : ",", names[i]);
  return text;
}

/// "second", "third", "4th", … "21st".
std::string ordinal(std::size_t n) {
  if (n == 2) return "second";
  if (n == 3) return "third";
  const std::size_t last = n % 10, teens = n / 10 % 10;
  const char* const ending = teens == 1 ? "th" : last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th";
  return fmt::format("{}{}", n, ending);
}

/// A sentence for every kind; a kind without one does not compile.
struct Sentence {
  std::string operator()(const diagnose::NoFreeMotion& of) const {
    return fmt::format("Clip {} holds no free motion of {} points or more.", of.clip, of.fewest);
  }
  std::string operator()(const diagnose::ThinnedPositions& of) const {
    return fmt::format("Of {} positions{}, every {} is used; more would slow the search without adding information.",
                       of.points, of.driven ? " with a recorded force" : "", ordinal(of.every));
  }
  std::string operator()(const diagnose::CutAtTurns& of) const {
    return fmt::format(
        "The recorded force turns the motion {} times. The motion is analysed in pieces of {} turns, each with a start "
        "of its own; anything that shows only over longer times, such as a slow drift, is not examined.",
        of.turns, of.turns_of_piece);
  }
  std::string operator()(const diagnose::SomePieces& of) const {
    return fmt::format(
        "Of {} pieces of motion with a recorded force, {} are analysed, spread evenly over clips and time.", of.pieces,
        of.kept);
  }
  std::string operator()(const diagnose::HandLeftOut& of) const {
    return fmt::format(
        "{} frames in which a hand or an end stop seems to act are excluded; no known effect explains them.",
        of.frames);
  }
  std::string operator()(const diagnose::HandExplained& of) const {
    return fmt::format(
        "{} frames in which a hand or an end stop seems to act are included: {} explains them. start_s and end_s of a "
        "clip leave them out, for a diagnosis of the free motion alone.",
        of.frames, effect_name(of.effect));
  }
  std::string operator()(const diagnose::SetAside& of) const {
    return fmt::format(
        "Of the {} positions of the motion, {:.0f} % are excluded: in them a hand or an end stop seems to act, or they "
        "are outliers, and no known effect explains them. {}",
        of.positions, 100.0 * of.part,
        of.is_large() ? "If a hand holds the body there, state when it lets go (start_s in experiment.toml)."
                      : "The verdict holds for the rest.");
  }
  std::string operator()(const diagnose::PiecesHeldOut&) const {
    return "There is only one clip: each piece of its motion is held out in turn.";
  }
  std::string operator()(const diagnose::QuartersHeldOut&) const {
    return "There is only one clip: the gap is measured on held-out quarters of it "
           "or, where it has three motions or more, on each of them.";
  }
  std::string operator()(const diagnose::LastingErrors& of) const {
    return fmt::format(
        "Errors of successive positions are correlated ({:.2f} from one frame to the next, {:.2f} to the fourth), as "
        "with a tracker that follows its own last image, or with positions that were smoothed: they carry less "
        "information than their number suggests.",
        of.next, of.fourth);
  }
  std::string operator()(const diagnose::StatementsDisagree& of) const {
    const char* const which = of.one != of.other                   ? "the stated inclination and that by the plumb line"
                              : of.one == diagnose::Against::plumb ? "the inclinations by two plumb lines"
                                                                   : "two stated inclinations";
    return fmt::format(
        "Set-up \"{}\": {} contradict each other by {:.1f} standard deviations. One of them is wrong, and the results "
        "that depend on them are uncertain.",
        of.group, which, of.z);
  }
  std::string operator()(const diagnose::NoInclination& of) const {
    return fmt::format(
        "Set{} {} neither a plumb line nor an inclination with its uncertainty (incline_sd_deg): effects that show "
        "only in the inclination ({}, {}, {}) cannot be seen there.",
        ups(of.groups), of.groups.size() > 1 ? "have" : "has", diagnose::ids::frame_rate_error,
        diagnose::ids::scale_error, diagnose::ids::direction_asymmetry);
  }
  std::string operator()(const diagnose::SuspectedFall& of) const {
    return fmt::format(
        "A hand seems to hold the body in {} positions, yet it accelerates at {:.2g} m/s² there, as in a fall. If it "
        "falls, state an inclination of 90° (--incline 90); the other results here do not hold in that case.",
        of.found.positions, of.found.a_m_s2);
  }
  std::string operator()(const diagnose::OfReading& of) const {
    return fmt::format("{}: {}.", of.clip, note_words(of.note));
  }
  std::string operator()(const diagnose::OneOrigin& of) const {
    if (of.left_out) {
      return "These are files by themselves, and nobody states that their positions count from one origin. So causes "
             "at a place (a cable, a bumper, a friction or a scale that varies along x) are not named. If there is one "
             "origin, put the files into a folder with an experiment.toml.";
    }
    return "Positions of all folders are taken to count from one origin. If they do not, friction, cables and bumpers "
           "at a place cannot be found: diagnose the folders one by one.";
  }
  std::string operator()(const diagnose::NoMassStated&) const {
    return "No mass is stated, and 1 kg is assumed. K/m, µ, α and terminal velocities do not depend on it; sizes in N, "
           "N/m, kg/m or kg are for each kilogram of the true mass.";
  }
  std::string operator()(const diagnose::ForceReversed& of) const {
    return fmt::format(
        "First check the sign of force_n: with the recorded force reversed, the nominal model leaves {} % of the chi² "
        "that it leaves now. A force is positive in the direction in which the file's x grows.",
        base::number_text(100.0 * of.part_of_chi2, 2));
  }
  std::string operator()(const diagnose::OnlyFalls&) const {
    return "The motions are falls, with an inclination of 80 degrees or more: there is almost no normal force, and µ "
           "is not determined. It is held at 0, and an inclination without incline_sd_deg counts as known to 1 degree.";
  }
  std::string operator()(const diagnose::FallsThroughAir& of) const {
    constexpr double kClearly = 2.3;  // log evidence: ten to one
    std::string words = fmt::format(
        "In air, a body that falls faster than 0.5 m/s is braked in proportion to the square of its speed. The gap is "
        "measured from a fall without any drag, and K/m is not given. If a magnet or a liquid brakes it, exclude this "
        "drag (--without {}).",
        diagnose::ids::quadratic_drag);
    if (of.over_viscous && *of.over_viscous > kClearly) {
      words += " The positions alone also prefer it to a viscous drag.";
    } else if (of.over_viscous) {
      words += *of.over_viscous < -kClearly
                   ? " The positions alone prefer a viscous drag: the name rests on how air brakes."
                   : " The positions alone do not tell it from a viscous drag: the name rests on how air brakes.";
    }
    if (!of.gaps) return words;
    return words + fmt::format(" A viscous drag alone would leave a gap of {:.3g} in place of {:.3g}{}.",
                               of.gaps->viscous, of.gaps->named,
                               of.viscous_leaves_less() ? ": air cannot brake like that" : "");
  }
  std::string operator()(const diagnose::OfCamera& of) const {
    return fmt::format(
        "If a motion sensor measured these positions, {} cannot act: say so (--recorded-by sensor, or recorded_by in "
        "experiment.toml).",
        list_of(effect_names(of.ids)));
  }
  std::string operator()(const diagnose::SensorPositions& of) const {
    if (of.column.empty())
      return "A motion sensor measured the positions, so what only a camera has is not considered.";
    return fmt::format(
        "\"{}\" is how a motion sensor's program heads its positions, so what only a camera has is not considered "
        "(--recorded-by camera if a camera measured them).",
        of.column);
  }
  std::string operator()(const diagnose::BuoyancyLooksAlike& of) const {
    if (of.as_inertia) {
      return fmt::format(
          "In a fall, buoyancy looks the same as such an inertia: it lowers the driving acceleration, here as in a "
          "fluid with {:.2g} of the density of the body, and drags are then {:.2g} times those given. The two "
          "densities show whether this is so.",
          of.density_ratio, 1.0 - of.density_ratio);
    }
    return fmt::format(
        "In a fall, buoyancy looks the same as such a scale or frame rate: it lowers the driving acceleration, here as "
        "in a fluid with {:.2g} of the density of the body. The two densities show whether this is so; a ruler in the "
        "image shows whether the scale is wrong, a stopwatch whether the frame rate is.",
        of.density_ratio);
  }
  std::string operator()(const diagnose::FitsCutOff& of) const {
    std::vector<std::string> names;
    for (const diagnose::Explanation& one : of.of) names.push_back(explanation_name(one));
    return fmt::format(
        "The fit{} of {} stopped at the limit on steps, before a minimum; {} may account for more of the gap than "
        "stated.",
        names.size() > 1 ? "s" : "", list_of(names), names.size() > 1 ? "these explanations" : "this explanation");
  }
  std::string operator()(const diagnose::SplitSetUps& of) const {
    return fmt::format("Clips of set{} state different inclinations; each inclination counts as a separate set-up.",
                       ups(of.groups));
  }
  std::string operator()(const diagnose::DoubtfulUnit& of) const {
    const FindingWords words = finding_words(of.found);
    return fmt::format("In clip {}, {}: {}.", of.clip, words.found, words.advice);
  }
  std::string operator()(const diagnose::OppositeLaunch& of) const {
    return fmt::format("Clip {} is stated as launched {}, but starts in the opposite direction.", of.clip,
                       of.stated_up ? "up" : "down");
  }
  std::string operator()(const diagnose::ContradictedReading& of) const {
    return fmt::format("With {:.6g} kg {}: {}.", of.mass_kg, contradiction_words(of.contradiction),
                       contradiction_causes(of.contradiction));
  }
  std::string operator()(const diagnose::NegativeLoss& of) const {
    const bool drag = of.of == diagnose::NegativeLoss::Of::drag;
    return fmt::format(
        "The fitted {} is below zero ({}), which would drive the glider: either the missing effect makes it negative, "
        "or the stated inclination, downhill direction or masses are wrong.",
        drag ? "drag" : "friction", base::size_and_sd_text(of.value, of.sd, drag ? "N s/m" : ""));
  }
  std::string operator()(const diagnose::ImpossibleSizes& of) const {
    std::vector<std::string> why;
    for (const diagnose::NegativeLoss& one : of.negative) {
      const bool drag = one.of == diagnose::NegativeLoss::Of::drag;
      why.push_back(fmt::format("{} = {} would drive the glider", drag ? "K" : "µ",
                                base::size_and_sd_text(one.value, one.sd, drag ? "N s/m" : "")));
    }
    if (!of.at_end.empty()) {
      why.push_back(
          fmt::format("the size of {} is at the limit of the range searched", list_of(effect_names(of.at_end))));
    }
    return fmt::format("The likeliest explanation, {}, cannot be right and is not named: with it, {}.",
                       list_of(effect_names(of.effects)), list_of(why));
  }
  std::string operator()(const diagnose::ContradictedIncline& of) const {
    const auto with_sd = [](double angle_rad, double sd_rad) {
      const double sd = base::kDegreesPerRad * sd_rad;
      return fmt::format("{:.{}f} ± {:.{}f}°", base::kDegreesPerRad * angle_rad, decimals_for(sd), sd,
                         decimals_for(sd));
    };
    const std::string stated = fmt::format("The inclination of set-up \"{}\" is {} {}, and the motion gives ", of.group,
                                           with_sd(of.stated_rad, of.stated_sd_rad),
                                           of.against == diagnose::Against::plumb ? "by the plumb line" : "as stated");
    if (!(of.motion_sd_rad > 0.0)) {
      return stated + fmt::format("{:.2f}° by the nominal model, which leaves out what is missing.",
                                  base::kDegreesPerRad * of.motion_rad);
    }
    return stated + fmt::format("{} by the {} ({:.3g} standard deviations apart).",
                                with_sd(of.motion_rad, of.motion_sd_rad),
                                of.named ? "model with the named effects" : "nominal model", of.z);
  }
  std::string operator()(const diagnose::BeyondGravity& of) const {
    return fmt::format(
        "Lines stated at {} degrees have a mean intercept of {:.3g} m/s², more than gravity ({:.6g} m/s²): no "
        "inclination can give that.",
        of.stated_deg, of.intercept_m_s2, of.gravity_m_s2);
  }
  std::string operator()(const diagnose::MeanIncline& of) const {
    return fmt::format(
        "The mean intercept of the lines stated at {}° corresponds to an inclination of {:.3f}°. A table does not say "
        "how well the angle was read; ±{}° is assumed.",
        of.stated_deg, of.intercept_deg, of.read_deg);
  }
  std::string operator()(const diagnose::TableOfLines& of) const {
    return fmt::format(
        "The table of {} lines states no errors: they are estimated from the scatter of the lines. It states no speeds "
        "either, so effects that depend on the speed ({}, {}, {}) cannot be examined.",
        of.lines, diagnose::ids::quadratic_drag, diagnose::ids::power_law_drag, diagnose::ids::stribeck);
  }
};

}  // namespace

std::string note_words(const diagnose::Note& note) {
  return std::visit(Sentence{}, note);
}

diagnose::ContradictedIncline as_told(diagnose::ContradictedIncline of, const diagnose::Diagnosis& diagnosis) {
  const bool missing = diagnosis.verdict != diagnose::Verdict::none && !only_statements_fail(diagnosis);
  if (missing && !of.named) of.motion_sd_rad = 0.0;
  return of;
}

std::vector<std::string> notes_words(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::string> sentences;
  for (const diagnose::Note& note : diagnosis.notes) {
    const auto* const incline = std::get_if<diagnose::ContradictedIncline>(&note);
    sentences.push_back(incline != nullptr ? note_words(as_told(*incline, diagnosis)) : note_words(note));
  }
  return sentences;
}

std::vector<std::string> notes_words(const std::vector<diagnose::Note>& notes) {
  std::vector<std::string> sentences;
  for (const diagnose::Note& note : notes) sentences.push_back(note_words(note));
  return sentences;
}

}  // namespace glidelab::report
