#include "diagnose/tracks/usable_motions.h"

#include <fmt/format.h>

#include <optional>
#include <utility>
#include <variant>

#include "base/errors.h"
#include "core/check/motion_look.h"
#include "core/result/image_record.h"

namespace glidelab::diagnose {

namespace {

bool is_of_units(const core::Found& found) {
  return std::holds_alternative<core::found::LongRun>(found) ||
         std::holds_alternative<core::found::SlowFrames>(found) ||
         std::holds_alternative<core::found::FallAboveGravity>(found);
}

}  // namespace

std::vector<DoubtfulUnit> doubtful_units(const core::AnalysisResults& results,
                                         const std::vector<core::ClipSetup>& setups) {
  std::vector<base::Issue> issues;
  std::vector<DoubtfulUnit> doubtful;
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    const core::ClipResult& clip = results.clips[c];
    if (clip.images && clip.images->combs > core::kInterlacedShare) {
      issues.push_back(
          {setups[c].file.string(), 0, fmt::format("clip \"{}\"", clip.name),
           "an interlaced film: the odd rows of a frame were seen half a frame earlier or later than the "
           "even ones",
           fmt::format(
               "a frame of each field (ffmpeg -vf bwdif) and frame_rate_hz = {:.6g}, or a film without interlacing",
               2.0 * clip.frame_rate_hz)});
    }
    for (const core::Finding& finding :
         core::motion_findings(core::look_at_motion(clip), setups[c], results.gravity_m_s2)) {
      if (is_of_units(finding.found)) doubtful.push_back({clip.name, finding.found});
      const auto* const fault = std::get_if<core::found::MotionFault>(&finding.found);
      if (fault == nullptr || finding.severity != core::Severity::unusable) continue;
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
