#include "report/diagnosis/words/next_step_words.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/math/angles.h"
#include "base/text/number_text.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

using diagnose::Change;
using diagnose::ChangeKind;

constexpr double kMostStated = 1000.0;  // expected log likelihood beyond which a larger figure has no meaning
constexpr const char* kMoveCamera =
    "what belongs to the track stays in place on it; what belongs to the image moves with the camera.";

const char* kind_words(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::launch:
      return "launches";
    case ChangeKind::mass:
      return "masses";
    case ChangeKind::inclination:
      return "inclinations";
    case ChangeKind::frame_rate:
      return "frame rates";
    case ChangeKind::exposure:
      return "exposures";
    case ChangeKind::plumb:
      return "a view of a plumb line";
    case ChangeKind::pattern:
      return "a check of the pattern";
    case ChangeKind::clock:
      return "a stopwatch";
  }
  return "";
}

/// "the 62 changes considered (launches, masses, …)"
std::string weighed_words(const diagnose::ChangesWeighed& of) {
  std::string kinds;
  for (const ChangeKind kind : of.kinds) kinds += (kinds.empty() ? "" : ", ") + std::string(kind_words(kind));
  return fmt::format("the {} changes considered ({})", of.count, kinds);
}

/// "uphill"; on a level track "towards smaller x".
std::string direction_words(const Change& change) {
  const bool forwards = change.clip->v0_m_s > 0.0;
  if (change.downhill == 0) return forwards ? "towards larger x" : "towards smaller x";
  return forwards == (change.downhill > 0) ? "downhill" : "uphill";
}

/// "Make the track level" or "Tilt the track to 6.0°".
std::string set_up_words(const diagnose::NextSetUp& set_up) {
  if (set_up.alpha_rad == 0.0) return "Make the track level";
  return fmt::format("Tilt the track to {:.1f}°", set_up.alpha_rad / base::kRadPerDegree);
}

/// "535 g"; where nobody states a mass, "the same mass" or "0.6 times the mass".
std::string mass_words(double mass_kg, bool assumed) {
  if (assumed) return mass_kg == 1.0 ? "the same mass" : base::number_text(mass_kg, 2) + " times the mass";
  return mass_kg < 1.0 ? base::digits_text(1000.0 * mass_kg, 3) + " g" : base::digits_text(mass_kg, 3) + " kg";
}

/// An instruction: "Record a launch uphill at 1.2 m/s with 535 g".
std::string change_words(const Change& change) {
  const std::string on = change.on.empty() ? "" : fmt::format(" on set-up \"{}\"", change.on);
  std::string launch, mass;
  if (change.clip) {
    constexpr double kRest_m_s = 1e-3;
    const double v0 = change.clip->v0_m_s;
    const std::string how = std::abs(v0) < kRest_m_s
                                ? "a release from rest"
                                : fmt::format("a launch {} at {:.2g} m/s", direction_words(change), std::abs(v0));
    const std::string record = change.set_up ? set_up_words(*change.set_up) + " and record" : "Record";
    launch = change.falls ? "Record a fall" : record + " " + how;
    mass = mass_words(change.clip->mass_kg, change.mass_assumed);
  }
  switch (change.kind) {
    case ChangeKind::launch:
      return fmt::format("{}{} with {}", launch, on, mass);
    case ChangeKind::mass:
      return fmt::format("{}{} with {}{}", launch, on, change.mass_assumed ? "" : "the mass changed to ", mass);
    case ChangeKind::inclination:
      return fmt::format("{} with {}", launch, mass);
    case ChangeKind::frame_rate:
      return fmt::format("{}{} with {} at {:.4g} frames per second instead of {:.4g}", launch, on, mass,
                         change.clip->rate_hz, change.rate_so_far_hz);
    case ChangeKind::exposure:
      return fmt::format("{}{} with {} with half the exposure (it halves the blur)", launch, on, mass);
    case ChangeKind::plumb:
      return fmt::format("Film a plumb line{} (it gives the inclination to {:.2g}°)", on,
                         change.statements.front().sd / base::kRadPerDegree);
    case ChangeKind::pattern:
      return fmt::format(
          "Lay the pattern (or a ruler) in the plane of motion on each half of the track, and compare its length there "
          "({:.1f} mm in {:.2g} m)",
          1000.0 * change.statements.front().sd, change.statements.front().to_m - change.statements.front().from_m);
    case ChangeKind::clock:
      return fmt::format("Film a running stopwatch for {:.0f} s (it shows the frame rate)",
                         1.0 / (change.statements.front().sd * change.rate_so_far_hz));
  }
  return {};
}

/// "quadratic drag together with shaking table"
std::string together_words(const diagnose::Explanation& of, const char* quote = "", const char* end = "") {
  std::vector<std::string> names;
  for (const std::string& id : of.effects) names.push_back(quote + explanation_name({{id}}) + end);
  return list_of(names, " together with ");
}

/// "a", "a or b", "a, b, or c"
std::string either_of(const std::vector<std::string>& words) {
  return list_of(words, words.size() > 2 ? ", or " : " or ");
}

/// "whether it is quadratic drag rather than power-law drag, and whether “more friction at low speed” acts".
std::string doubt_words(const std::vector<diagnose::Alternative>& doubt) {
  std::vector<std::string> contests, acts;
  std::vector<std::pair<std::string, std::vector<std::string>>> instead;  // for each that may be right, the others
  for (const diagnose::Alternative& of : doubt) {
    if (of.other.is_nothing()) {
      acts.push_back(together_words(of.one, "“", "”"));
      continue;
    }
    const std::string one = together_words(of.one);
    if (instead.empty() || instead.back().first != one) instead.push_back({one, {}});
    instead.back().second.push_back(together_words(of.other));
  }
  for (const auto& [one, others] : instead) {
    contests.push_back(fmt::format("whether it is {} rather than {}", one, either_of(others)));
  }
  if (!acts.empty()) contests.push_back(fmt::format("whether {} acts", either_of(acts)));
  return list_of(contests, ", and ");
}

/// Expected log likelihood of a clip below which no number of clips would do.
constexpr double kNoHelp = 1e-3;

std::string likelihood_words(double gain) {
  if (gain > kMostStated) return fmt::format("more than {:.0f}", kMostStated);
  return gain < 10.0 ? fmt::format("{:.1f}", gain) : fmt::format("{:.0f}", gain);
}

std::string routine_words(diagnose::Routine routine) {
  using diagnose::Routine;
  switch (routine) {
    case Routine::repeat_each_kind:
      return "Repeat one launch of each kind: more clips make the verdict more certain.";
    case Routine::repeat_launch:
      return "Repeat one of the launches three times without changing anything: what differs between the repetitions "
             "is not due to the law of motion.";
    case Routine::start_later:
      return "Repeat one of the launches three times, each time one second later in the clip: what "
             "depends on the time in the clip (a clock, something that warms up or settles) stays at that time; what "
             "acts on the glider shifts with it.";
    case Routine::turn_glider:
      return "Turn the glider round on the track and record the same launches each way: what belongs to the glider "
             "turns with it; what belongs to the track does not.";
    case Routine::set_up_again:
      return "Take the track down, set it up again at the same inclination, and record the same launches: what differs "
             "then comes from setting it up, not from the inclination.";
    case Routine::move_camera:
      return std::string(
                 "Move the camera along the track by a third of the view and record the same launches again: ") +
             kMoveCamera;
    case Routine::other_speeds:
      return "Record launches at two further speeds, with one mass and at one inclination: the missing force depends "
             "on the speed, and its shape shows what it is.";
    case Routine::other_forces:
      return "Drive the glider over the same stretch again with half and with twice the force: what depends on the "
             "speed changes with it; what depends on position does not.";
    case Routine::measure_inclination:
      return "Measure the inclination again, with a level on the track or a plumb line in the image: the motion and "
             "the stated value cannot both be right.";
    case Routine::check_statements:
      return "Check the stated downhill direction, inclinations and masses, then launch one glider both ways: friction "
             "slows it in both directions, an inclination does not.";
    case Routine::second_mass:
      return "Record a second mass: with one mass, load-independent friction cannot be told from µ.";
  }
  return {};
}

/// Words for every kind of step; a kind without them does not compile.
struct Words {
  std::string operator()(std::monostate) const { return {}; }

  std::string operator()(diagnose::Routine of) const { return routine_words(of); }

  std::string operator()(const diagnose::RepeatClip& of) const {
    return fmt::format(
        "Repeat clip {} three times without changing anything: what belongs to that clip alone does not recur; what is "
        "caused by its launch, mass or set-up recurs each time.",
        of.clip);
  }

  std::string operator()(const diagnose::CoverRegion& of) const {
    const bool places = of.over == diagnose::CoverRegion::Over::places;
    const std::string launch = fmt::format(
        "{}: of {} launches considered, it has the most positions ({} of {}) at {} from {} to {} {}, where the "
        "remainder is clearest",
        change_words(of.launch), of.launches, of.inside, of.positions, places ? "positions" : "speeds",
        base::number_text(of.from, 2), base::number_text(of.to, 2), places ? "m" : "m/s");
    if (!places) return launch + ", and the dependence on the speed shows what is missing.";
    return fmt::format("Move the camera along the track by a third of the view. {}; {}", launch, kMoveCamera);
  }

  std::string operator()(const diagnose::AddMass& of) const {
    return fmt::format(
        "Record {} both ways, and the lightest one again: what depends on the mass then has a "
        "third point on its curve; what differed by chance does not recur.",
        of.assumed ? mass_words(of.mass_kg, true) : fmt::format("a further mass of {:.0f} g", 1000.0 * of.mass_kg));
  }

  std::string operator()(const diagnose::RecordForEffect& of) const {
    return of.doubt ? fmt::format("It is uncertain {}. {}", doubt_words({*of.doubt}), of.words) : of.words;
  }

  std::string operator()(const diagnose::SettleDoubt& of) const {
    if (!of.by && of.log_likelihood < kNoHelp) {
      return fmt::format(
          "None of {} would decide {}, however many clips: the motion is the same either way. Check directly for what "
          "is in doubt (on the set-up, the scale, the clock), remove or correct what you find, and record the same "
          "launch again.",
          weighed_words(of.weighed), doubt_words(of.doubt));
    }
    if (!of.by) {
      return fmt::format(
          "None of {} would decide {} (expected gain in log likelihood at most {:.2g}): less noise (a longer lens, a "
          "larger "
          "marker) or many more clips would.",
          weighed_words(of.weighed), doubt_words(of.doubt), of.log_likelihood);
    }
    return fmt::format("{}: of {}, this one best decides {} (expected gain in log likelihood {}).",
                       change_words(*of.by), weighed_words(of.weighed), doubt_words(of.doubt),
                       likelihood_words(of.log_likelihood));
  }

  std::string operator()(const diagnose::SharpenParameter& of) const {
    const base::NamedUnit named = !of.effect.empty() ? base::name_and_unit(of.key)
                                  : of.key == "mu"   ? base::NamedUnit{"µ", ""}
                                                     : base::NamedUnit{of.key, of.key == "K" ? "N s/m" : ""};
    const std::string weighed = weighed_words(of.weighed);
    std::string text = of.undecided.empty()
                           ? "No other explanation is likely."
                           : fmt::format("None of {} would decide {}.", weighed, doubt_words(of.undecided));
    text += fmt::format(" The least well known parameter is {}{} ({}).", named.name,
                        of.effect.empty() ? "" : " of " + explanation_name({{of.effect}}),
                        base::size_and_sd_text(of.value, of.sd, named.unit));
    const std::string_view which = of.undecided.empty() ? std::string_view(weighed) : "these";
    if (of.by) {
      text += fmt::format(" {}: of {}, this one reduces its uncertainty most, to ± {}.", change_words(*of.by), which,
                          base::size_text(of.sd_after, 2, named.unit));
    } else {
      text += fmt::format(
          " None of {} would reduce its uncertainty by 5 %; n times as many clips of each kind would reduce it by a "
          "factor of sqrt(n).",
          which);
    }
    if (of.one_mass) {
      text += " With one mass, load-independent friction cannot be told from µ; a second mass would separate them.";
    }
    return text;
  }

  std::string operator()(const diagnose::TellLinesApart& of) const {
    return fmt::format(
        "Analyse the same clips with half and with twice the bandwidth: a smoothing bias changes with its square; "
        "a friction force does not change. Or record a glider of {:.0f} g both ways: a friction force of {} shifts "
        "each of its intercepts by {}, the smoothing bias by {}.",
        1000.0 * of.mass_kg, base::size_text(of.force_n, 2, "N"), base::size_text(of.by_force_m_s2, 2, "m/s²"),
        base::size_text(of.by_bias_m_s2, 2, "m/s²"));
  }
};

}  // namespace

std::string next_step_words(const diagnose::NextStep& step) {
  return std::visit(Words{}, step);
}

}  // namespace glidelab::report
