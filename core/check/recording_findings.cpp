#include "core/check/recording_findings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <variant>

#include "base/math/angles.h"
#include "core/check/check_result.h"
#include "core/check/light_findings.h"
#include "core/check/motion_look.h"
#include "core/check/statement_findings.h"
#include "core/pictures/frames/frame_source.h"
#include "core/result/estimate.h"
#include "core/result/image_record.h"
#include "core/track/bare_track.h"

namespace glidelab::core {

namespace {

// docs/reference/check.md gives the reason for each limit.
constexpr std::size_t kFewViews = 8;
constexpr double kMostPatternRmsPx = 0.3, kUnusablePatternRmsPx = 1.0;  // rms of the camera's fit, per corner
constexpr double kLeastPlaneRmsPx = 0.05, kMostPlaneOverNoise = 3.0, kUnusablePlaneRmsPx = 1.0;
constexpr double kLeastCovered = 0.5;  // of the image's parts
constexpr double kLeastTiltDeg = 20.0;

void judge_pattern(const PatternCheck& pattern, FindingBook book) {
  if (!pattern.failure.empty()) {
    const std::size_t images = pattern.views.size() + pattern.without.size();
    book.add(Severity::unusable, found::NoCamera{pattern.failure, pattern.views.size(), images});
    return;
  }
  if (!pattern.without.empty()) book.add(Severity::change, found::NoPatternIn{pattern.without});
  if (!pattern.calibration) return;
  const CalibrationResult& camera = *pattern.calibration;
  if (camera.views_used < kFewViews) book.add(Severity::change, found::FewViews{camera.views_used});
  if (camera.rms_px > kMostPatternRmsPx) {
    book.add(camera.rms_px > kUnusablePatternRmsPx ? Severity::unusable : Severity::change,
             found::CornersOff{camera.rms_px});
  }
  if (pattern.covered < kLeastCovered) book.add(Severity::change, found::LittleCovered{pattern.covered});
  double tilt_deg = 0.0;
  for (const PatternView& view : pattern.views) tilt_deg = std::max(tilt_deg, view.tilt_deg);
  if (tilt_deg < kLeastTiltDeg) book.add(Severity::change, found::LittleTilt{tilt_deg});
  if (camera.plane_rms_px > std::max(kLeastPlaneRmsPx, kMostPlaneOverNoise * camera.plane_expected_px)) {
    book.add(camera.plane_rms_px > kUnusablePlaneRmsPx ? Severity::unusable : Severity::change,
             found::PlaneViewsOff{camera.plane_rms_px, camera.plane_expected_px});
  }
  for (const Note& note : camera.notes) {
    if (!std::holds_alternative<NoPatternInSight>(note)) book.add(Severity::note, note);  // reported above, with advice
  }
}

// Of clips.

constexpr std::size_t kUnusableSightings = 20, kFewSightings = 60;
// Of a track from a file: fewer leave less than six positions in excess of what a fit determines from them.
constexpr std::size_t kLeastOfFall = 9, kLeastOnTrack = 11;
constexpr double kLeastSeenShare = 0.95, kUnusableSeenShare = 2.0 / 3.0;
constexpr std::size_t kMostUnseenAtEnd = 3;  // frames at a clip's start or end
constexpr double kLeastPathInside = 0.95;    // of the marker's path
constexpr double kSmallMarkerPx = 6.0, kUnusableMarkerPx = 3.0;
constexpr double kLeastContrast = 0.15, kLeastSignalToNoise = 20.0, kUnusableSignalToNoise = 5.0;
constexpr double kMostPullChange_px = 0.15;  // ten times the part due to a centroid's noise
constexpr double kLeastContrastAlong = 0.5;  // of the largest along the path
constexpr double kLeastBrightLevel = 0.25, kMostSaturatedShare = 0.05;
constexpr double kMostBlur = 0.5, kUnusableBlur = 2.0;                        // marker diameters
constexpr double kUnusableMissingShare = 0.01, kUnusableRepeatedShare = 0.1;  // shares of the frames
constexpr double kMostDriftFrames = 0.75;                                     // frames

/// Of x264: 0.4 at its default rate factor of 23, 0.7 at 26 (docs/evidence/other-renderers.md).
constexpr double kMostBlockSteps = 0.5;
/// Where every frame is compressed by itself, errors do not last: with steps of 1.6 the centre errs by 0.02 px.
constexpr double kMostBlockStepsAlone = 2.0;

void judge_codec(const ClipCheck& clip, FindingBook& book) {
  if (clip.combs > kInterlacedShare) book.add(Severity::unusable, found::Interlaced{clip.frame_rate_hz});
  if (clip.block_steps > (clip.frames_alone ? kMostBlockStepsAlone : kMostBlockSteps))
    book.add(Severity::change, found::StrongCompression{clip.block_steps});
}

void judge_times(const Experiment& experiment, const ClipCheck& clip, FindingBook& book) {
  const auto frames = static_cast<double>(std::max<std::size_t>(clip.frames, 1));
  const bool by_rate = experiment.camera->time == TimeSource::rate;
  if (clip.container_rate_hz && std::abs(*clip.container_rate_hz / clip.frame_rate_hz - 1.0) > kRateRounding) {
    const bool playback = is_playback(*clip.container_rate_hz, clip.frame_rate_hz);
    book.add(by_rate && !playback ? Severity::change : Severity::note,
             found::OtherRateInFile{*clip.container_rate_hz, clip.frame_rate_hz, by_rate}, Topic::time);
  }
  if (clip.drift_frames > kMostDriftFrames) {
    book.add(by_rate ? Severity::unusable : Severity::note,
             found::UnevenStamps{clip.drift_frames, clip.irregular_steps, by_rate});
  }
  if (clip.jumps > 0 && by_rate) {
    const double share = static_cast<double>(clip.jumps) / static_cast<double>(std::max<std::size_t>(clip.seen, 1));
    book.add(share > kUnusableMissingShare ? Severity::unusable : Severity::change, found::Jumps{clip.jumps});
  }
  if (clip.repeated + clip.stalls > 0) {
    const double share = static_cast<double>(std::max(clip.repeated, clip.stalls)) / frames;
    const bool hold = clip.repeats && (clip.repeats->in_place_of_lost || clip.repeats->camera_hz > 0.0);
    book.add(share > kUnusableRepeatedShare && !hold ? Severity::unusable : Severity::change,
             found::FramesRepeated{clip.repeated, clip.frames, clip.stalls, hold});
  }
}

void judge_light(const ClipCheck& clip, FindingBook& book) {
  if (clip.marker_level && *clip.marker_level > kSaturatedLevel) {
    book.add(Severity::change, found::MarkerSaturated{});
  }
  if (clip.saturated > kMostSaturatedShare) book.add(Severity::change, found::PixelsSaturated{clip.saturated});
  // A small marker covers less of the image than the quantile leaves out.
  const double brightest = std::max(clip.bright_level, clip.marker_level.value_or(0.0));
  if (brightest < kLeastBrightLevel) book.add(Severity::change, found::Dark{brightest});
  if (clip.contrast && *clip.contrast < kLeastContrast) {
    book.add(Severity::change, found::LittleContrast{*clip.contrast});
  }
  if (clip.contrast && *clip.contrast < kLeastSignalToNoise * clip.pixel_noise) {
    const double signal = *clip.contrast / clip.pixel_noise;
    book.add(signal < kUnusableSignalToNoise ? Severity::unusable : Severity::change, found::NoisyContrast{signal});
  }
}

/// Light that varies with position, and its effect on the marker's apparent centre.
void judge_lighting(const ClipCheck& clip, FindingBook& book) {
  if (!clip.light) return;
  found::LitFromOneSide side{clip.light->pull_px, clip.light->pull_change_px, {}, false};
  if (clip.top_speed_m_s > 0.0 && clip.top_speed_px_s > 0.0) side.px_per_m = clip.top_speed_px_s / clip.top_speed_m_s;
  side.changes = side.change_px > kMostPullChange_px;
  if (side.changes || is_lit_from_one_side(clip)) {
    book.add(side.changes ? Severity::change : Severity::note, side);
  }
  if (clip.light->least_contrast < kLeastContrastAlong) {
    book.add(Severity::change, found::ContrastFalls{clip.light->least_contrast});
  }
}

/// A marker that is smeared away where the glider is fastest is missing at a clip's start or end.
void judge_ends(const ClipCheck& clip, FindingBook& book) {
  const auto judge = [&](std::size_t unseen, const found::UnseenAtEnd& end) {
    if (unseen <= kMostUnseenAtEnd) return;
    const double share = static_cast<double>(unseen) / static_cast<double>(clip.frames);
    book.add(end.at_edge                        ? Severity::note
             : share > 1.0 - kUnusableSeenShare ? Severity::unusable
                                                : Severity::change,
             end);
  };
  const std::size_t last = clip.first + clip.spanned;
  judge(clip.first, {true, clip.first + 1, clip.frames, clip.entered});
  judge(clip.frames - last, {false, last, clip.frames, clip.left});
}

void judge_marker(const ClipCheck& clip, FindingBook& book) {
  const std::size_t left_out = clip.repeats ? clip.repeats->repeats : 0;
  const std::size_t looked_at = clip.spanned - std::min(clip.spanned, left_out);
  const double share = static_cast<double>(clip.seen) / static_cast<double>(std::max<std::size_t>(looked_at, 1));
  if (clip.seen < kFewSightings) {
    book.add(clip.seen < kUnusableSightings ? Severity::unusable : Severity::change, found::FewSightings{clip.seen});
  }
  if (share < kLeastSeenShare) {
    book.add(share < kUnusableSeenShare ? Severity::unusable : Severity::change,
             found::SightingsMissing{clip.seen, looked_at});
  }
  judge_ends(clip, book);
  if (clip.marker_px < kSmallMarkerPx) {
    book.add(clip.marker_px < kUnusableMarkerPx ? Severity::unusable : Severity::change,
             found::SmallMarker{clip.marker_px});
  }
  if (clip.measured_exposure_s) {
    book.add(Severity::change, found::LongExposure{*clip.measured_exposure_s, clip.blur_px.has_value()});
  }
  const double blur_px = likely_blur_px(clip);
  if (blur_px > kMostBlur * clip.marker_px) {
    const bool known = clip.blur_px.has_value() || clip.measured_blur_px.has_value();
    book.add(known && blur_px > kUnusableBlur * clip.marker_px ? Severity::unusable : Severity::change,
             found::Smeared{clip.top_speed_m_s, blur_px, clip.marker_px, known});
  }
  if (clip.inside_pattern < kLeastPathInside) {
    book.add(Severity::change, found::OutsidePattern{1.0 - clip.inside_pattern});
  }
}

void judge_clip(const Experiment& experiment, const ClipCheck& clip, FindingBook book) {
  if (!clip.failure.empty()) {
    book.add(Severity::unusable, found::NotTracked{clip.failure, clip.images}, Topic::failure);
    return;
  }
  // The analysis leaves it out. What was followed in its place has the stated size after all: the size is no cause.
  const auto other =
      std::ranges::find_if(clip.notes, [](const Note& note) { return std::holds_alternative<NotOfStatedSize>(note); });
  if (other != clip.notes.end() && !size_disagrees(clip)) {
    book.add(Severity::unusable, found::NotTracked{std::get<NotOfStatedSize>(*other).failure, clip.images},
             Topic::failure);
    return;
  }
  if (clip.images) {
    judge_marker(clip, book);
    judge_light(clip, book);
    judge_lighting(clip, book);
    judge_codec(clip, book);
    judge_times(experiment, clip, book);
  } else if (clip.seen < kFewSightings) {
    found::FewPositions few{clip.seen};
    for (const Note& note : clip.notes) {
      const auto* const incomplete = std::get_if<RowsIncomplete>(&note);
      if (incomplete != nullptr && incomplete->rows > clip.seen) few.unmarked = incomplete->rows;
    }
    const bool falls = std::any_of(experiment.clips.begin(), experiment.clips.end(), [&](const ClipSetup& setup) {
      return setup.name == clip.name && is_fall(setup.incline_rad);
    });
    book.add(clip.seen < (falls ? kLeastOfFall : kLeastOnTrack) ? Severity::unusable : Severity::change, few);
  }
  if (!clip.interruptions.empty()) {
    const Interruption& first = clip.interruptions.front();
    book.add(Severity::change, found::Interrupted{first.from_s, first.to_s, clip.interruptions.size()});
  }
  const bool inclined = std::any_of(experiment.clips.begin(), experiment.clips.end(), [&](const ClipSetup& setup) {
    return setup.name == clip.name && !setup.incline_assumed;
  });
  for (const Note& note : clip.notes) {
    const auto* const held = std::get_if<ValuesHeld>(&note);
    if (held != nullptr) book.add(Severity::change, found::SlowSensor{*held});
    const bool reported =
        held != nullptr || std::holds_alternative<RepeatedFrames>(note) || std::holds_alternative<MarkerLost>(note) ||
        std::holds_alternative<InterlacedFilm>(note) || std::holds_alternative<ContainerOfOtherRate>(note) ||
        (clip.images && std::holds_alternative<RepeatsLeftOut>(note)) ||
        (inclined && std::holds_alternative<HeightTaken>(note)) ||                  // asks whether it falls
        (std::holds_alternative<MarkerOfOtherSize>(note) && size_disagrees(clip));  // above, with advice
    if (!reported) book.add(Severity::note, note);
  }
}

/// What the program assumes of a file on its own.
void note_assumptions(const std::vector<ClipSetup>& setups, std::vector<Finding>& findings) {
  for (const ClipSetup& setup : setups) {
    found::AssumedForFile assumed;
    if (setup.mass_assumed) assumed.mass_kg = setup.mass_kg;
    if (setup.incline_assumed) assumed.incline_deg = setup.incline_rad * base::kDegreesPerRad + 0.0;  // no "-0"
    if (!assumed.mass_kg && !assumed.incline_deg) continue;
    findings.push_back({Severity::note, {Subject::Part::clips, {setup.name}}, assumed});
  }
}

}  // namespace

std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<Finding> findings = statement_findings(experiment, check);
  if (check.pattern) judge_pattern(*check.pattern, {findings, {Subject::Part::pattern}});
  const bool any_moves =
      !std::ranges::all_of(check.clips, [](const ClipCheck& clip) { return is_at_rest(clip.motion); });
  for (const ClipCheck& clip : check.clips) {
    // A wrong unit or a motion that is none explains what else is found.
    for (const ClipSetup& setup : experiment.clips) {
      if (setup.name != clip.name) continue;
      for (Finding& finding : motion_findings(clip.motion, setup, experiment.gravity_m_s2, any_moves)) {
        findings.push_back(std::move(finding));
      }
    }
    judge_clip(experiment, clip, {findings, {Subject::Part::clips, {clip.name}}});
  }
  std::ranges::move(light_findings(experiment, check.clips), std::back_inserter(findings));
  note_assumptions(experiment.clips, findings);
  findings = with_root_causes(experiment, check, std::move(findings));
  if (!check.plumb_failure.empty()) {
    findings.push_back({Severity::unusable, {Subject::Part::plumb_line}, found::NoPlumbAngle{check.plumb_failure}});
  }
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) > static_cast<int>(b.severity);
  });
  return findings;
}

namespace {

// docs/reference/check.md gives the reason for each limit.
constexpr double kLargestSquare_m = 0.5, kUsualSquare_m = 0.03;
constexpr double kLargestMarker_m = 0.5, kUsualMarker_m = 0.02;
constexpr double kLongestTrack_m = 20.0, kUsualTrack_m = 1.5;
constexpr double kLeastScale_px_m = 20.0, kUsualScale_px_m = 500.0;
constexpr double kMostOverGravity = 1.05, kMostSpeedingUp = 2.0;
constexpr double kSameAngle_deg = 0.5, kSameAngleShare = 0.15;

/// One root cause and what it explains.
struct Root {
  Finding finding;
  std::vector<Topic> explains;
};

/// Every length that the pattern, the scale or the file's unit gives.
const std::vector<Topic> kByLength = {Topic::length, Topic::incline, Topic::failure};

std::optional<Root> long_length(const char* key, double value, double largest_m, double usual_m,
                                std::vector<Topic> explains, Subject::Part about) {
  if (value <= largest_m) return std::nullopt;
  return Root{{Severity::unusable, {about}, found::LengthInUnit{key, value, likely_unit(value, usual_m)}},
              std::move(explains)};
}

void add(std::optional<Root> root, std::vector<Root>& roots) {
  if (root) roots.push_back(std::move(*root));
}

std::optional<Root> heavy(const Experiment& experiment, double longest_m) {
  if (longest_m > kLongestRun_m) return std::nullopt;  // sledges and cars may be that heavy
  std::vector<std::string> names;
  double mass_kg = 0.0, least_kg = HUGE_VAL;
  for (const ClipSetup& clip : experiment.clips) {
    least_kg = std::min(least_kg, clip.mass_kg);
    if (clip.mass_kg < kLargestMass_kg) continue;
    names.push_back(clip.name);
    mass_kg = std::max(mass_kg, clip.mass_kg);
  }
  // If others are in kilograms, mass_kg contradicts itself, which is a finding of its own.
  if (names.empty() || least_kg < kLargestMass_kg) return std::nullopt;
  return Root{{Severity::change, {Subject::Part::clips, std::move(names)}, found::MassInGrams{mass_kg}}, {Topic::mass}};
}

std::vector<Root> stated_roots(const Experiment& experiment, double longest_m) {
  std::vector<Root> roots;
  if (experiment.calibration) {
    add(long_length("square_m", experiment.calibration->square_m, kLargestSquare_m, kUsualSquare_m, kByLength,
                    Subject::Part::pattern),
        roots);
  }
  if (experiment.scale && experiment.scale->px_per_m < kLeastScale_px_m) {
    const double value = experiment.scale->px_per_m;
    const LengthUnit unit = likely_unit(1.0 / value, 1.0 / kUsualScale_px_m);
    roots.push_back({{Severity::unusable, {Subject::Part::scale}, found::ScaleInUnit{value, unit}}, kByLength});
  }
  if (experiment.marker) {
    add(long_length("diameter_m", experiment.marker->diameter_m, kLargestMarker_m, kUsualMarker_m,
                    {Topic::size, Topic::failure}, Subject::Part::marker),
        roots);
    add(long_length("height_m", std::abs(experiment.marker->height_m), kLargestMarker_m, kUsualMarker_m, kByLength,
                    Subject::Part::marker),
        roots);
  }
  if (experiment.track.length_m) {
    add(long_length("length_m", *experiment.track.length_m, kLongestTrack_m, kUsualTrack_m, {}, Subject::Part::track),
        roots);
  }
  add(heavy(experiment, longest_m), roots);
  return roots;
}

/// By the stated inclination, if both directions show the acceleration without friction; else by the usual distance.
LengthUnit track_unit(const Experiment& experiment, const RecordingCheck& check, double distance_m) {
  const bool assumed = std::any_of(experiment.clips.begin(), experiment.clips.end(),
                                   [](const ClipSetup& clip) { return clip.incline_assumed; });
  for (const ConfigurationResult& configuration : check.configurations) {
    const auto off = incline_contradiction(configuration, experiment.gravity_m_s2, stated_incline(configuration));
    if (assumed || !off || !off->beyond_gravity || std::abs(configuration.incline_deg) < kSameAngle_deg) continue;
    const double sine = std::sin(std::abs(configuration.incline_deg) / base::kDegreesPerRad);
    return likely_unit(std::abs(*off->beyond_gravity), experiment.gravity_m_s2 * sine);
  }
  return likely_unit(distance_m, kUsualRun_m);
}

/// Tracks with accelerations that no incline causes and distances that no track has.
std::optional<Root> long_tracks(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<std::string> names;
  double distance_m = 0.0;
  for (const ClipCheck& clip : check.clips) {
    const bool beyond = clip.motion.acceleration_m_s2.value_or(0.0) > kMostOverGravity * experiment.gravity_m_s2 ||
                        clip.motion.speeding_up_m_s2 > kMostSpeedingUp * experiment.gravity_m_s2;
    if (clip.images || clip.distance_m < kLongestRun_m || !beyond) continue;
    names.push_back(clip.name);
    distance_m = std::max(distance_m, clip.distance_m);
  }
  if (names.empty()) return std::nullopt;
  return Root{{Severity::unusable,
               {Subject::Part::clips, std::move(names)},
               found::TrackInUnit{distance_m, track_unit(experiment, check, distance_m)}},
              kByLength};
}

bool same_angle(double one_deg, double other_deg) {
  return std::abs(one_deg - other_deg) < std::max(kSameAngle_deg, kSameAngleShare * std::abs(other_deg));
}

std::optional<Root> wrong_angle_or_rate(const Experiment& experiment, const RecordingCheck& check) {
  if (std::any_of(experiment.clips.begin(), experiment.clips.end(),
                  [](const ClipSetup& clip) { return clip.incline_assumed; }))
    return std::nullopt;
  for (const ConfigurationResult& configuration : check.configurations) {
    if (!configuration.alpha_deg.estimate) continue;
    const auto off = incline_contradiction(configuration, experiment.gravity_m_s2, stated_incline(configuration));
    if (!off || !off->gross) continue;
    const double stated = configuration.incline_deg, alpha = configuration.alpha_deg.estimate->value;
    const double as_radians = stated * base::kDegreesPerRad;
    if (std::abs(as_radians) > 1.0 && same_angle(as_radians, alpha)) {
      return Root{{Severity::unusable,
                   {Subject::Part::clips, configuration.clips},
                   found::InclineInRadians{stated, as_radians, alpha}},
                  {Topic::incline}};
    }
    for (const ClipCheck& clip : check.clips) {
      if (!clip.container_rate_hz || !experiment.camera || !(clip.frame_rate_hz > 0.0)) continue;
      const double ratio = *clip.container_rate_hz / clip.frame_rate_hz;
      const double sine = std::sin(alpha / base::kDegreesPerRad) * ratio * ratio;
      if (std::abs(ratio - 1.0) < 0.01 || std::abs(sine) >= 1.0) continue;
      const double at_rate = std::asin(sine) * base::kDegreesPerRad;
      if (!same_angle(at_rate, stated)) continue;
      return Root{{Severity::unusable,
                   {Subject::Part::clips, configuration.clips},
                   found::WrongFrameRate{clip.frame_rate_hz, *clip.container_rate_hz, at_rate}},
                  {Topic::incline, Topic::time, Topic::length}};
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Finding> unit_findings(const Experiment& experiment, double longest_m) {
  std::vector<Finding> findings;
  for (Root& root : stated_roots(experiment, longest_m)) findings.push_back(std::move(root.finding));
  return findings;
}

bool explains_failures(const Experiment& experiment) {
  const std::vector<Root> roots = stated_roots(experiment, 0.0);
  return std::any_of(roots.begin(), roots.end(), [](const Root& root) {
    return std::find(root.explains.begin(), root.explains.end(), Topic::failure) != root.explains.end();
  });
}

std::vector<Finding> with_root_causes(const Experiment& experiment, const RecordingCheck& check,
                                      std::vector<Finding> findings) {
  double longest_m = 0.0;
  for (const ClipCheck& clip : check.clips) longest_m = std::max(longest_m, clip.distance_m);
  std::optional<Root> tracks = long_tracks(experiment, check);
  if (tracks) longest_m = 0.0;  // a distance in another unit lets no mass pass
  std::vector<Root> roots = stated_roots(experiment, longest_m);
  const bool length_known = std::none_of(roots.begin(), roots.end(), [](const Root& root) {
    return std::find(root.explains.begin(), root.explains.end(), Topic::incline) != root.explains.end();
  });
  if (length_known) {
    add(tracks ? std::move(tracks) : wrong_angle_or_rate(experiment, check), roots);
  }
  std::vector<Finding> result;
  for (Root& root : roots) {
    const auto follows = [&](const Finding& finding) {
      return std::find(root.explains.begin(), root.explains.end(), finding.topic) != root.explains.end();
    };
    std::copy_if(findings.begin(), findings.end(), std::back_inserter(root.finding.follow), follows);
    std::erase_if(findings, follows);
    result.push_back(std::move(root.finding));
  }
  result.insert(result.end(), std::make_move_iterator(findings.begin()), std::make_move_iterator(findings.end()));
  return result;
}

}  // namespace glidelab::core
