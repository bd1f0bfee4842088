#include "diagnose/tracks/usable_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "base/errors.h"
#include "core/check/motion_look.h"
#include "core/check/statement_findings.h"
#include "core/result/estimate.h"
#include "core/result/image_record.h"
#include "core/result/uphill.h"

namespace glidelab::diagnose {

namespace {

bool is_of_units(const core::Found& found) {
  return std::holds_alternative<core::found::LongRun>(found) ||
         std::holds_alternative<core::found::SlowFrames>(found) ||
         std::holds_alternative<core::found::FallAboveGravity>(found);
}

std::string file_of(const core::ClipSetup& setup) {
  return (setup.track.empty() ? setup.file : setup.track).string();
}

/// What is stated of the direction of the motions, and is wrong for certain: the launch of most clips, and which way x
/// rises.
void add_contradictions(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                        std::vector<base::Issue>& issues) {
  std::vector<base::Issue> against;
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    const core::ClipResult& clip = results.clips[c];
    if (!core::moves_against_launch(clip.against_launch)) continue;
    against.push_back({file_of(setups[c]), 0, fmt::format("clip \"{}\"", clip.name),
                       fmt::format("motion opposite to launched = \"{}\", {:.0f} % of it",
                                   core::name_of(setups[c].launched), 100.0 * clip.against_launch->share),
                       "launched of this clip and downhill of its track that agree with the motion; if they are right, "
                       "state in start_s when the hand lets go"});
  }
  // One such clip of several is a slip of its own, and the analysis leaves its motion out.
  if (2 * against.size() > results.clips.size()) std::ranges::move(against, std::back_inserter(issues));
  for (const core::ConfigurationResult& of : results.configurations) {
    if (of.incline_assumed || of.clips.empty()) continue;
    const auto off = core::incline_contradiction(of, results.gravity_m_s2, core::stated_incline(of));
    if (!off || !core::seems_uphill(*off)) continue;
    const auto setup = std::ranges::find(setups, of.clips.front(), &core::ClipSetup::name);
    issues.push_back({setup != setups.end() ? file_of(*setup) : "", 0, fmt::format("clip \"{}\"", of.clips.front()),
                      fmt::format("x that seems to be positive uphill: the motion gives an inclination of {:.2f}°, and "
                                  "{:.2f}° is stated",
                                  off->deg, off->stated.deg),
                      "x that rises downhill: the opposite downhill in experiment.toml, or the inclination with the "
                      "other sign"});
  }
}

}  // namespace

std::vector<DoubtfulUnit> doubtful_units(const core::AnalysisResults& results,
                                         const std::vector<core::ClipSetup>& setups) {
  std::vector<base::Issue> issues;
  std::vector<DoubtfulUnit> doubtful;
  std::vector<core::MotionLook> looks;
  for (const core::ClipResult& clip : results.clips) looks.push_back(core::look_at_motion(clip));
  const bool any_moves = !std::ranges::all_of(looks, core::is_at_rest);
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
    for (const core::Finding& finding : core::motion_findings(looks[c], setups[c], results.gravity_m_s2, any_moves)) {
      if (is_of_units(finding.found)) doubtful.push_back({clip.name, finding.found});
      const auto* const fault = std::get_if<core::found::MotionFault>(&finding.found);
      if (fault == nullptr || finding.severity != core::Severity::unusable) continue;
      core::found::FaultWords words = core::found::fault_words(*fault);
      issues.push_back({file_of(setups[c]), 0, fmt::format("clip \"{}\"", clip.name), std::move(words.found),
                        fmt::format("the motion of a body along a straight incline ({})", words.advice)});
    }
  }
  add_contradictions(results, setups, issues);
  if (!issues.empty()) throw base::InputError(std::move(issues));
  for (const core::ConfigurationResult& configuration : results.configurations) {
    const std::optional<core::SlowFall> fall = core::slow_fall(configuration, results.gravity_m_s2);
    if (!fall || configuration.clips.empty()) continue;
    doubtful.push_back({configuration.clips.front(), core::found::FallsSlowly{*fall}});
  }
  return doubtful;
}

}  // namespace glidelab::diagnose
