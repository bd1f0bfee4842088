#include "report/diagnosis/note_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/text/size_text.h"

namespace glidelab::report {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Decimals of a value to the first digit of its standard deviation, two at least.
int decimals_for(double sd) {
  return sd > 0.0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(sd))), 2, 9) : 2;
}

/// `-ups "a", "b"`, or `-up "a"` of one.
std::string ups(const std::vector<std::string>& names) {
  std::string text = names.size() > 1 ? "-ups" : "-up";
  for (std::size_t i = 0; i < names.size(); ++i) text += fmt::format("{} \"{}\"", i == 0 ? "" : ",", names[i]);
  return text;
}

/// A sentence for every kind; a kind without one does not compile.
struct Sentence {
  std::string operator()(const diagnose::NoFreeMotion& of) const {
    return fmt::format("Clip {} holds no free motion of {} points or more.", of.clip, of.fewest);
  }
  std::string operator()(const diagnose::ThinnedPositions& of) const {
    return fmt::format("Of {} positions{}, one in {} is used: the law needs no more, and more would slow the search.",
                       of.points, of.driven ? " with a recorded force" : "", of.every);
  }
  std::string operator()(const diagnose::CutAtTurns& of) const {
    return fmt::format(
        "The recorded force turns the motion {} times. The motion is weighed in pieces of {} turns, each with a start "
        "of its own; anything that shows only over longer times, such as a slow drift, is not examined.",
        of.turns, of.turns_of_piece);
  }
  std::string operator()(const diagnose::SomePieces& of) const {
    return fmt::format(
        "Of {} pieces of motion with a recorded force, {} are weighed, spread evenly over clips and time.", of.pieces,
        of.kept);
  }
  std::string operator()(const diagnose::HandLeftOut& of) const {
    return fmt::format("{} frames that look like a hand or a stop are left out; no effect of the list explains them.",
                       of.frames);
  }
  std::string operator()(const diagnose::SetAside& of) const {
    return fmt::format(
        "Of the {} positions of the motion, {:.0f} % are set aside: they look like a hand or a stop, or lie far off, "
        "and no effect of the list explains them. The verdict holds for the rest.",
        of.positions, 100.0 * of.part);
  }
  std::string operator()(const diagnose::PiecesHeldOut&) const {
    return "There is only one clip: each piece of its motion is held out in turn.";
  }
  std::string operator()(const diagnose::QuartersHeldOut&) const {
    return "There is only one clip, and no other to predict it from: the gap is measured on held-out quarters of it.";
  }
  std::string operator()(const diagnose::LastingErrors& of) const {
    return fmt::format(
        "Errors of successive positions are correlated ({:.2f} from one frame to the next, {:.2f} to the fourth), as "
        "with a tracker that follows its own last image, or with positions that were smoothed: they tell less than "
        "their number suggests.",
        of.next, of.fourth);
  }
  std::string operator()(const diagnose::StatementsDisagree& of) const {
    return fmt::format(
        "Set-up \"{}\": the {} and the {} inclination contradict each other by {:.1f} standard deviations. One of them "
        "is wrong, and the results that depend on them are uncertain.",
        of.group, of.one, of.other, of.z);
  }
  std::string operator()(const diagnose::NoInclination& of) const {
    return fmt::format(
        "Set{} {} neither a plumb line nor an inclination with its uncertainty (incline_sd_deg): effects that show "
        "only in the inclination (frame_rate_error, scale_error, direction_asymmetry) cannot be seen there.",
        ups(of.groups), of.groups.size() > 1 ? "have" : "has");
  }
  std::string operator()(const diagnose::SplitSetUps& of) const {
    return fmt::format("Clips of set{} state different inclinations; each inclination counts as a set-up of its own.",
                       ups(of.groups));
  }
  std::string operator()(const diagnose::LaunchedOtherWay& of) const {
    return fmt::format("Clip {} is stated as launched {}, but starts in the opposite direction.", of.clip,
                       of.stated_up ? "up" : "down");
  }
  std::string operator()(const diagnose::NegativeLoss& of) const {
    const bool drag = of.of == diagnose::NegativeLoss::Of::drag;
    return fmt::format(
        "The fit has a {} below zero ({}), which would drive the glider: either the missing effect pushes it there, or "
        "the stated inclination, downhill direction or masses are wrong.",
        drag ? "drag" : "friction", base::size_and_sd_text(of.value, of.sd, drag ? "N s/m" : ""));
  }
  std::string operator()(const diagnose::ContradictedIncline& of) const {
    const double sd = kDegrees * of.motion_sd_rad;
    return fmt::format(
        "The inclination of set-up \"{}\" is {:.2f} ± {:.2g}° {}, and the motion says {:.{}f} ± {:.1g}° by the {} "
        "({:.3g} standard deviations apart).",
        of.group, kDegrees * of.stated_rad, kDegrees * of.stated_sd_rad,
        of.against == "plumb" ? "by the plumb line" : "as " + of.against, kDegrees * of.motion_rad, decimals_for(sd),
        sd, of.named ? "model with the named effects" : "nominal model", of.z);
  }
  std::string operator()(const diagnose::BeyondGravity& of) const {
    return fmt::format(
        "Lines stated at {} degrees have a mean intercept of {:.3g} m/s², more than gravity ({:.6g} m/s²): no "
        "inclination has it.",
        of.stated_deg, of.intercept_m_s2, of.gravity_m_s2);
  }
  std::string operator()(const diagnose::MeanIncline& of) const {
    return fmt::format(
        "Lines stated at {} degrees have the mean intercept of {:.3f} degrees. A table does not say how well the angle "
        "was read; {} degrees are assumed.",
        of.stated_deg, of.intercept_deg, of.read_deg);
  }
  std::string operator()(const diagnose::TableOfLines& of) const {
    return fmt::format(
        "A table of {} lines states no errors: they are taken from the scatter of the lines. It states no speeds "
        "either, so effects of the speed (quadratic_drag, power_law_drag, stribeck) cannot be weighed.",
        of.lines);
  }
};

}  // namespace

std::string note_words(const diagnose::Note& note) {
  return std::visit(Sentence{}, note);
}

std::vector<std::string> notes_words(const std::vector<diagnose::Note>& notes) {
  std::vector<std::string> sentences;
  for (const diagnose::Note& note : notes) sentences.push_back(note_words(note));
  return sentences;
}

}  // namespace glidelab::report
