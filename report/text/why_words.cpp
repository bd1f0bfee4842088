#include "report/text/why_words.h"

#include <fmt/format.h>

#include <utility>
#include <variant>

#include "core/result/results.h"

namespace glidelab::report {
namespace {

namespace unknown = core::unknown;

const char* incline_words(bool would_do) {
  return would_do ? ", unless the inclination is stated with its uncertainty (incline_deg and incline_sd_deg; for a "
                    "file --incline and --incline-sd)"
                  : "";
}

/// Words for every reason; a reason without them does not compile.
struct ReasonWords {
  std::string operator()(const unknown::Told& of) const { return of.text; }

  std::string operator()(const unknown::NoLine& of) const {
    std::string text = "no line: neither direction has enough usable points";
    bool gaps = false;
    const char* before = "; left out are ";
    for (const auto& [reason, count] : of.left_out) {
      text += fmt::format("{}{}{} ({})", std::exchange(before, ", "), count,
                          &reason == &of.left_out.front().first ? fmt::format(" of {} positions", of.positions) : "",
                          core::describe(reason));
      gaps = gaps || reason == core::LeftOut::kernel_gap;
    }
    if (gaps) {
      text +=
          ". The smoothing needs positions at an even rate; the fit of the whole motion does not (--estimator "
          "trajectory)";
    }
    return text;
  }
  std::string operator()(const unknown::NoDownhillLine&) const { return "no line for v > 0"; }
  std::string operator()(const unknown::SpeedHardlyChanges&) const {
    return "the speed hardly changes in the positions that are used, so they determine no slope";
  }
  std::string operator()(const unknown::NotBothLines& of) const {
    return fmt::format("no line for {}; only motion in both directions separates friction from inclination{}",
                       of.minus && of.plus ? "v < 0 and none for v > 0"
                       : of.minus          ? "v < 0"
                                           : "v > 0",
                       incline_words(of.incline_would_do));
  }
  std::string operator()(const unknown::MeanBeyondGravity& of) const {
    return fmt::format("the mean of a0 is {:.4g} m/s², which is gravity or more", of.mean_m_s2);
  }

  std::string operator()(const unknown::RateNotPositive& of) const {
    return fmt::format("K/m{} is not above zero by more than its uncertainty", of.of_line ? " for v > 0" : "");
  }
  std::string operator()(const unknown::InterceptNotPositive&) const {
    return "nothing drives the glider downhill: at v = 0 the line for v > 0 is not above zero by more than its "
           "uncertainty";
  }

  std::string operator()(const unknown::NoFreeMotion&) const { return "no free motion"; }
  std::string operator()(const unknown::NoFit&) const {
    return "the fit of the whole motion does not converge, or the motion does not determine its parameters";
  }
  std::string operator()(const unknown::OneDirection& of) const {
    const bool plus = of.direction > 0;
    return fmt::format(
        "motion with v {} 0 only: it determines g (sin(alpha) {} mu cos(alpha)) = {:.4f} ± {:.4f} m/s², not alpha and "
        "mu separately{}",
        plus ? ">" : "<", plus ? "-" : "+", of.a0_m_s2, of.sd_m_s2, incline_words(of.incline_would_do));
  }
  std::string operator()(const unknown::NoDownhillMotion&) const { return "no motion with v > 0"; }
  std::string operator()(const unknown::DriveBeyondGravity&) const {
    return "the acceleration without friction exceeds gravity: no inclination gives that";
  }

  std::string operator()(const unknown::NotTold&) const { return "the estimator gave no value and did not say why"; }
  std::string operator()(const unknown::NotAnswered&) const {
    return "the estimator's results.json has no such configuration";
  }

  std::string operator()(const unknown::NoLineOfMotion&) const {
    return "the marker does not move, so its line is unknown";
  }

  std::string operator()(const unknown::NoMinimum&) const {
    return "the fit with the named causes stopped before it reached a minimum";
  }
  std::string operator()(const unknown::NotToldApart&) const {
    return "these motions do not separate it from the other quantities";
  }
  std::string operator()(const unknown::AtItsLimit&) const {
    return "the fit ends at the limit of what is allowed for it: the model or a statement is wrong";
  }
  std::string operator()(const unknown::ExplanationsDiffer&) const {
    return "the likely explanations give values that differ too much";
  }
  std::string operator()(const unknown::FreeFall&) const { return "a fall has no normal force, and so no friction"; }
  std::string operator()(const unknown::NoBalance&) const {
    return "the forces do not balance at any downhill speed below 1000 m/s";
  }
  std::string operator()(const unknown::DragNotViscous&) const {
    return "the drag is not viscous: it grows with the square of the speed";
  }
  std::string operator()(const unknown::KernelNotStated&) const {
    return "a table states neither the bandwidth nor the stretch to which each line was fitted";
  }
};

}  // namespace

std::string why_words(const std::optional<core::WhyUnknown>& why) {
  if (!why) return "";
  std::string text = std::visit(ReasonWords{}, why->reason);
  for (const core::ClipAgainstLaunch& one : why->against_launch) {
    text +=
        fmt::format("; {}: {} (as launched and downhill in experiment.toml say)", one.clip, launch_words(one.motion));
  }
  return text;
}

std::string launch_words(const core::AgainstLaunch& against) {
  const char* const moving = against.direction > 0 ? "+x" : "-x";
  const char* const launch = against.direction > 0 ? "-x" : "+x";
  if (!against.until_s) return fmt::format("it moves towards {} only: the launch was towards {}", moving, launch);
  return fmt::format(
      "motion towards {} before {:.3f} s is attributed to the hand and excluded, since the launch was towards {}",
      moving, *against.until_s, launch);
}

}  // namespace glidelab::report
