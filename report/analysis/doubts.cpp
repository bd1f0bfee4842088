#include "report/analysis/doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>

#include "base/text/number_text.h"
#include "core/check/finding.h"
#include "core/result/quantity.h"
#include "report/analysis/note_words.h"
#include "report/analysis/statement_words.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr double kOffLine = 2.0;                         // times the noise: more than a wrong noise estimate explains
constexpr double kAboveGravity = 0.05, kAboveSds = 2.5;  // of g, one sd: lengths are known that well

/// Downhill friction brakes: without drag no slope gives more than g, and a line that begins above it is too steep.
/// gravity_m_s2 is 0 if it is not stated.
bool begins_above_gravity(const core::LineFit& line, double gravity_m_s2) {
  if (line.direction < 0 || !(gravity_m_s2 > 0.0)) return false;
  const double sd_m_s2 = std::hypot(line.a0_m_s2.sd, kAboveGravity * gravity_m_s2);
  return line.a0_m_s2.value - gravity_m_s2 > kAboveSds * sd_m_s2;
}

/// Of the clips of the configuration whose positions come from a file.
double longest_range_m(const core::AnalysisResults& results, const core::ConfigurationResult& configuration) {
  double longest = 0.0;
  for (const core::ClipResult& clip : results.clips) {
    if (!clip.sightings.empty() || !std::ranges::count(configuration.clips, clip.name)) continue;
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (const core::MotionPoint& point : clip.motion) {
      if (!point.measured_m) continue;
      least = std::min(least, *point.measured_m);
      most = std::max(most, *point.measured_m);
    }
    longest = std::max(longest, most - least);
  }
  return longest;
}

/// "run 2: the motion turns 4 times, …": of the first clip of a configuration that is no run along an incline; empty if
/// all are, or rest: a law that nothing follows is not in doubt.
std::string no_run_words(const core::AnalysisResults& results, const core::ConfigurationResult& configuration) {
  for (const core::ClipResult& clip : results.clips) {
    if (!std::ranges::count(configuration.clips, clip.name)) continue;
    for (const core::Note& note : clip.notes) {
      const auto* const no_run = std::get_if<core::NoRun>(&note);
      if (no_run != nullptr && !no_run->at_rest) return fmt::format("{}: {}.", clip.name, note_words(note));
    }
  }
  return {};
}

}  // namespace

bool nothing_moves(const core::AnalysisResults& results) {
  return !results.clips.empty() && std::ranges::all_of(results.clips, [](const core::ClipResult& clip) {
    return std::ranges::any_of(clip.notes, [](const core::Note& note) {
      const auto* const no_run = std::get_if<core::NoRun>(&note);
      return no_run != nullptr && no_run->at_rest;
    });
  });
}

bool is_below_zero(const core::Estimate& of) {
  return of.value < -kLeastDoubtSds * of.sd && of.high95 < 0.0;
}

std::vector<std::string> doubts_about(const core::AnalysisResults& results) {
  std::vector<std::string> doubts;
  for (const core::ConfigurationResult& c : results.configurations) {
    if (std::string words = no_run_words(results, c); !words.empty()) doubts.push_back(std::move(words));
    const auto below_zero = [](const core::Quantity& quantity) {
      return quantity.estimate && is_below_zero(*quantity.estimate);
    };
    const auto doubt = [&](core::Measurand which, const char* reason) {
      const core::Quantity& quantity = core::value_of(c, which);
      if (!below_zero(quantity)) return;
      doubts.push_back(fmt::format("{}: {} = {} is below zero, which {}.", configuration_name(results, c),
                                   symbol_of(core::key_of(which)),
                                   base::value_and_sd_text(quantity.estimate->value, quantity.estimate->sd), reason));
    };
    doubt(core::Measurand::k_over_m, "no drag can cause");
    doubt(core::Measurand::mu, "no friction can cause");
    for (const core::LineFit& line : c.lines) {
      if (!begins_above_gravity(line, results.gravity_m_s2)) continue;
      const std::string begins =
          fmt::format("{}: the line's intercept at v = 0 is {} m/s², more than gravity", configuration_name(results, c),
                      base::value_and_sd_text(line.a0_m_s2.value, line.a0_m_s2.sd));
      const double range_m = longest_range_m(results, c);
      if (const std::optional<core::LengthUnit> unit = core::unit_of_long_run(range_m)) {
        const double per_metre = core::per_metre(*unit);
        doubts.push_back(fmt::format(
            "{}, and x covers {:.4g}, which looks like {} ({:.3g} m). Give x in metres: divide the column by {:.0f}, "
            "or name its unit in the header.",
            begins, range_m, core::name_of(*unit).many, range_m / per_metre, per_metre));
      } else if (line.k_over_m_1_s.value > kLeastDoubtSds * line.k_over_m_1_s.sd) {
        doubts.push_back(begins +
                         ": K/m is too large. Either the drag grows faster than proportionally to the speed, "
                         "or the motion is not free at its start.");
      } else {
        doubts.push_back(begins +
                         ", and no drag explains that: check the units of x and of the times, and that the "
                         "motion is free.");
      }
    }
    const std::optional<core::SlowFall> fall = core::slow_fall(c, results.gravity_m_s2);
    const bool steady = std::ranges::any_of(
        c.notes, [](const core::Note& note) { return std::holds_alternative<core::SteadyFall>(note); });
    if (fall && !steady) {  // of a constant speed the law says no more, and a note says so
      doubts.push_back(fmt::format("{}: {}.", configuration_name(results, c), slow_fall_words(*fall)));
    }
  }
  const core::ClipResult* farthest = nullptr;
  const core::LineFit* line = nullptr;
  for (const core::ClipResult& clip : results.clips) {
    for (const core::LineFit& of : clip.segments) {
      if (std::isinf(of.parts.degrees) || of.parts.scatter < kOffLine) continue;
      if (line != nullptr && of.parts.scatter <= line->parts.scatter) continue;
      farthest = &clip;
      line = &of;
    }
  }
  if (line != nullptr) {
    doubts.push_back(fmt::format("{}, v {} 0: the points lie {} times as far from their line as the noise explains.",
                                 farthest->name, line->direction > 0 ? ">" : "<",
                                 base::number_text(line->parts.scatter, 2)));
  }
  for (const core::ConfigurationResult& c : results.configurations) {
    if (!c.scatter || *c.scatter < kOffLine) continue;
    doubts.push_back(
        fmt::format("{}: the positions lie {} times as far from the fitted motion as their noise explains.",
                    configuration_name(results, c), base::number_text(*c.scatter, 2)));
  }
  if (!doubts.empty()) {
    const bool of_speeds = std::ranges::any_of(
        results.clips, [](const core::ClipResult& clip) { return clip.speed_noise_m_s.has_value(); });
    doubts.push_back(fmt::format(
        "The law (drag proportional to the speed, dry friction, gravity) does not fit these clips as they are. {}",
        of_speeds ? "glidelab diagnose needs positions: speeds alone do not show what is missing."
                  : "Next: glidelab check (is the recording good enough?), then glidelab diagnose (what is missing "
                    "from the law?)."));
  }
  return doubts;
}

}  // namespace glidelab::report
