#include "diagnose/tracks/usable_motions.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <variant>

#include "base/errors.h"
#include "core/check/motion_look.h"

namespace glidelab::diagnose {

namespace {

bool is_of_units(const core::Found& found) {
  return std::holds_alternative<core::found::LongRun>(found) ||
         std::holds_alternative<core::found::SlowFrames>(found) ||
         std::holds_alternative<core::found::FallAboveGravity>(found);
}

/// The motion without what is stated not to be free.
core::MotionLook look_at(const core::ClipResult& clip) {
  std::vector<double> t_s, x_m;
  for (const core::MotionPoint& point : clip.motion) {
    const bool stated_out = point.left_out == core::LeftOut::before_start || point.left_out == core::LeftOut::after_end;
    if (!point.measured_m || stated_out) continue;
    t_s.push_back(point.t_s);
    x_m.push_back(*point.measured_m);
  }
  return core::look_at_motion(t_s, x_m, clip.sightings, clip.forced);
}

}  // namespace

std::vector<DoubtfulUnit> doubtful_units(const core::AnalysisResults& results,
                                         const std::vector<core::ClipSetup>& setups) {
  std::vector<base::Issue> issues;
  std::vector<DoubtfulUnit> doubtful;
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    const core::ClipResult& clip = results.clips[c];
    for (const core::Finding& finding : core::motion_findings(look_at(clip), setups[c], results.gravity_m_s2)) {
      if (is_of_units(finding.found)) doubtful.push_back({clip.name, finding.found});
      const auto* const fault = std::get_if<core::found::MotionFault>(&finding.found);
      if (fault == nullptr) continue;
      core::found::FaultWords words = core::found::fault_words(*fault);
      issues.push_back({(setups[c].track.empty() ? setups[c].file : setups[c].track).string(), 0,
                        fmt::format("clip \"{}\"", clip.name), std::move(words.found),
                        fmt::format("the motion of a body along a straight incline ({})", words.advice)});
    }
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  for (const core::ConfigurationResult& configuration : results.configurations) {
    const std::optional<core::SlowFall> fall = core::slow_fall(configuration, results.gravity_m_s2);
    if (!fall || configuration.clips.empty()) continue;
    doubtful.push_back({configuration.clips.front(), core::found::FallsSlowly{*fall}});
  }
  return doubtful;
}

}  // namespace glidelab::diagnose
