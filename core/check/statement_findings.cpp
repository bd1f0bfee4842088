#include "core/check/statement_findings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/check/check_result.h"
#include "core/pictures/camera/restitution.h"
#include "core/result/estimate.h"
#include "core/track/bare_track.h"

namespace glidelab::core {
namespace {

// docs/reference/check.md gives the reason for each limit.
constexpr double kMostSizeDifference = 0.15;      // of the logarithm
constexpr double kUnusableSizeDifference = 0.26;  // 30 %
// Of a marker whose outline is no circle with the stated diameter: a square has the area of a disc 13 % wider than its
// side, and glare widens, or a threshold narrows, what is saturated.
constexpr double kMostVagueDifference = 0.4, kUnusableVagueDifference = 0.7;
constexpr double kMostSmearForSize = 0.5;  // marker diameters of smear, above which an outline is no measure of size
constexpr double kLeastShareAgainstLaunch = 0.25;  // share of the points that move freely
constexpr double kLargePull = 0.05;    // of the diameter: a centroid of its light so far off its outline's centre
constexpr double kLeastLitPart = 0.5;  // of the diameter: half a ball, lit from the side
constexpr double kMostDistanceOverLength = 1.05;  // of length_m

double size_off(const ClipCheck& clip) {
  return clip.marker_expected_px > 0.0 && clip.marker_px > 0.0
             ? std::abs(std::log(clip.marker_px / clip.marker_expected_px))
             : 0.0;
}

bool has_vague_size(const ClipCheck& clip) {
  const bool saturated = clip.marker_level && *clip.marker_level > kSaturatedLevel;
  return saturated || std::any_of(clip.notes.begin(), clip.notes.end(), [](const Note& note) {
           const auto* const measured = std::get_if<MarkerMeasuredBy>(&note);
           return measured != nullptr && measured->what != MarkerMeasuredBy::What::shading;
         });
}

LengthSources lengths_of(const Experiment& experiment) {
  const auto is_track = [](const ClipSetup& clip) { return clip.file.empty(); };
  return {experiment.calibration.has_value(), experiment.scale.has_value(),
          std::any_of(experiment.clips.begin(), experiment.clips.end(), is_track)};
}

/// Gliders of one track do not differ that much; grams and kilograms do.
void judge_masses(const Experiment& experiment, std::vector<Finding>& findings) {
  const auto lighter = [](const ClipSetup& a, const ClipSetup& b) { return a.mass_kg < b.mass_kg; };
  const auto least = std::min_element(experiment.clips.begin(), experiment.clips.end(), lighter);
  found::MassesApart apart{{}, {least->name, least->mass_kg}, kMassRatio};
  for (const ClipSetup& clip : experiment.clips) {
    if (clip.mass_kg >= kMassRatio * least->mass_kg) apart.heavy.push_back({clip.name, clip.mass_kg});
  }
  if (apart.heavy.empty()) return;
  findings.push_back({Severity::unusable, {Subject::Part::masses}, std::move(apart), Topic::mass});
}

/// One finding for all clips: they share the marker and the scale.
void judge_size(const Experiment& experiment, const std::vector<ClipCheck>& clips, std::vector<Finding>& findings) {
  std::vector<std::string> names;
  const ClipCheck* worst = nullptr;
  bool contradicts = false;
  for (const ClipCheck& clip : clips) {
    if (!size_disagrees(clip)) continue;
    names.push_back(clip.name);
    if (worst == nullptr || size_off(clip) > size_off(*worst)) worst = &clip;
    contradicts =
        contradicts || (size_off(clip) > (has_vague_size(clip) ? kUnusableVagueDifference : kUnusableSizeDifference) &&
                        likely_blur_px(clip) <= kMostSmearForSize * clip.marker_px);
  }
  if (worst == nullptr) return;
  findings.push_back({contradicts ? Severity::unusable : Severity::change,
                      {Subject::Part::clips, std::move(names)},
                      found::MarkerSizeOff{worst->marker_px, worst->marker_expected_px, std::expm1(size_off(*worst)),
                                           experiment.scale.has_value()},
                      Topic::size});
}

/// A marker cannot run farther than the track is long.
void judge_distance(const Experiment& experiment, const std::vector<ClipCheck>& clips, std::vector<Finding>& findings) {
  if (!experiment.track.length_m) return;
  std::vector<std::string> names;
  double distance_m = 0.0;
  for (const ClipCheck& clip : clips) {
    if (clip.distance_m <= kMostDistanceOverLength * *experiment.track.length_m) continue;
    names.push_back(clip.name);
    distance_m = std::max(distance_m, clip.distance_m);
  }
  if (names.empty()) return;
  findings.push_back({Severity::unusable,
                      {Subject::Part::clips, std::move(names)},
                      found::BeyondTrack{distance_m, *experiment.track.length_m, lengths_of(experiment)},
                      Topic::length});
}

/// The configuration of a group that contradicts the stated inclination most.
struct Worst {
  const ConfigurationResult* configuration = nullptr;
  InclineContradiction contradiction;
};

void keep_worse(const ConfigurationResult& configuration, const std::optional<InclineContradiction>& found,
                std::map<std::string, Worst>& worst) {
  if (!found) return;
  Worst& of_group = worst[configuration.group];
  if (of_group.configuration != nullptr && std::pair(of_group.contradiction.gross, of_group.contradiction.off_deg) >=
                                               std::pair(found->gross, found->off_deg)) {
    return;
  }
  of_group = {&configuration, *found};
}

/// One finding for a group: its clips share the inclination.
void judge_incline(const Experiment& experiment, const RecordingCheck& check, std::vector<Finding>& findings) {
  std::map<std::string, Worst> by_key, by_plumb;
  const bool any_assumed = std::any_of(experiment.clips.begin(), experiment.clips.end(),
                                       [](const ClipSetup& clip) { return clip.incline_assumed; });
  for (const ConfigurationResult& configuration : check.configurations) {
    const auto against = [&](const StatedIncline& stated) {
      return incline_contradiction(configuration, experiment.gravity_m_s2, stated);
    };
    if (!any_assumed) keep_worse(configuration, against(stated_incline(configuration)), by_key);
    for (const PlumbResult& plumb : check.plumbs) {
      if (plumb.group != configuration.group || !plumb.plumb_deg.estimate) continue;
      const Estimate& angle = *plumb.plumb_deg.estimate;
      keep_worse(configuration, against({angle.value, angle.sd, "the plumb line"}), by_plumb);
    }
  }
  for (const auto* worst_of : {&by_key, &by_plumb}) {
    for (const auto& [group, worst] : *worst_of) {
      if (worst_of == &by_plumb && by_key.contains(group)) continue;  // reported above
      findings.push_back({worst.contradiction.gross ? Severity::unusable : Severity::change,
                          {Subject::Part::clips, worst.configuration->clips},
                          found::InclineOff{worst.contradiction, lengths_of(experiment), experiment.camera.has_value()},
                          Topic::incline});
    }
  }
}

/// One finding for all falls, with the first of them.
void judge_falls(const Experiment& experiment, const RecordingCheck& check, std::vector<Finding>& findings) {
  std::vector<std::string> names;
  std::optional<SlowFall> first;
  for (const ConfigurationResult& configuration : check.configurations) {
    const std::optional<SlowFall> fall = slow_fall(configuration, experiment.gravity_m_s2);
    if (!fall) continue;
    names.insert(names.end(), configuration.clips.begin(), configuration.clips.end());
    if (!first) first = fall;
  }
  if (!first) return;
  findings.push_back(
      {Severity::change, {Subject::Part::clips, std::move(names)}, found::FallsSlowly{*first}, Topic::length});
}

/// Where the downhill stands that a clip goes by: in its own [group], or in [track].
bool is_own_downhill(const Experiment& experiment, const ClipSetup& clip) {
  const GroupSetup* group = group_of(experiment, clip.group);
  return group != nullptr && group->downhill.has_value();
}

/// One finding for all clips, with the worst of them: one wrong key in [track] turns them all.
void judge_launch(const Experiment& experiment, const std::vector<ClipCheck>& clips, std::vector<Finding>& findings) {
  std::vector<std::string> names;
  found::AgainstStatedLaunch worst;
  bool own = false, shared = false;
  for (const ClipCheck& clip : clips) {
    const auto setup = std::find_if(experiment.clips.begin(), experiment.clips.end(),
                                    [&](const ClipSetup& of) { return of.name == clip.name; });
    if (setup == experiment.clips.end() || !moves_against_launch(clip.against_launch)) continue;
    (is_own_downhill(experiment, *setup) ? own : shared) = true;
    names.push_back(clip.name);
    if (names.size() > 1 && clip.against_launch->share <= worst.motion.share) continue;
    worst.motion = *clip.against_launch;
    worst.clip = clip.name;
    worst.launched = name_of(setup->launched);
    const std::optional<Downhill> downhill = downhill_of(experiment, setup->group);
    worst.downhill = downhill ? std::optional(name_of(*downhill)) : std::nullopt;
  }
  if (names.empty()) return;
  worst.against = names.size();
  worst.clips = clips.size();
  using Stated = found::AgainstStatedLaunch::Stated;
  worst.stated = own && shared ? Stated::in_either : own ? Stated::in_group : Stated::in_track;
  findings.push_back({Severity::unusable, {Subject::Part::clips, std::move(names)}, std::move(worst)});
}

}  // namespace

bool moves_against_launch(const std::optional<AgainstLaunch>& against) {
  if (!against || against->share < kLeastShareAgainstLaunch) return false;
  return !against->until_s || against->at_a_turn;
}

bool is_lit_from_one_side(const ClipCheck& clip) {
  return clip.light && clip.light->pull_px > kLargePull * clip.marker_px;
}

bool size_disagrees(const ClipCheck& clip) {
  if (size_off(clip) <= (has_vague_size(clip) ? kMostVagueDifference : kMostSizeDifference)) return false;
  // A smear makes it longer.
  const double smear_px = std::max(clip.measured_blur_px.value_or(0.0), clip.blur_px.value_or(0.0));
  if (clip.marker_px > clip.marker_expected_px && clip.marker_px < clip.marker_expected_px + smear_px) return false;
  // What is seen of it is the lit part.
  const bool lit_part = is_lit_from_one_side(clip) && clip.marker_px < clip.marker_expected_px &&
                        clip.marker_px > kLeastLitPart * clip.marker_expected_px;
  return !lit_part;
}

double likely_blur_px(const ClipCheck& clip) {
  return std::max(clip.measured_blur_px.value_or(0.0),
                  clip.blur_px.value_or(clip.measured_blur_px ? 0.0 : clip.longest_blur_px));
}

std::vector<Finding> statement_findings(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<Finding> findings;
  judge_masses(experiment, findings);
  judge_size(experiment, check.clips, findings);
  judge_distance(experiment, check.clips, findings);
  judge_incline(experiment, check, findings);
  judge_falls(experiment, check, findings);
  judge_launch(experiment, check.clips, findings);
  return findings;
}

}  // namespace glidelab::core
