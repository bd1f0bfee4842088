#include "core/check/root_causes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "base/math/angles.h"
#include "core/result/estimate.h"
#include "core/track/bare_track.h"

namespace glidelab::core {
namespace {

// docs/reference/check.md gives the reason for each limit.
constexpr double kLargestSquare_m = 0.5, kUsualSquare_m = 0.03;
constexpr double kLargestMarker_m = 0.5, kUsualMarker_m = 0.02;
constexpr double kLongestTrack_m = 20.0, kUsualTrack_m = 1.5;
constexpr double kLeastScale_px_m = 20.0, kUsualScale_px_m = 500.0;
constexpr double kLongestRun_m = 20.0, kUsualRun_m = 1.0;
constexpr double kMostOverGravity = 1.05;
constexpr double kSameAngle_deg = 0.5, kSameAngleShare = 0.15;

/// Whichever of centimetres and millimetres brings the value closest to the usual one.
LengthUnit likely_unit(double value, double usual_m) {
  const auto off = [&](LengthUnit unit) { return std::abs(std::log(value / per_metre(unit) / usual_m)); };
  return off(LengthUnit::centimetres) < off(LengthUnit::millimetres) ? LengthUnit::centimetres
                                                                     : LengthUnit::millimetres;
}

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

/// Tracks with accelerations that no incline causes and distances that no track has.
std::optional<Root> long_tracks(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<std::string> names;
  double distance_m = 0.0;
  for (const ClipCheck& clip : check.clips) {
    const double a = clip.motion.acceleration_m_s2.value_or(0.0);
    if (clip.images || clip.distance_m < kLongestRun_m || a < kMostOverGravity * experiment.gravity_m_s2) continue;
    names.push_back(clip.name);
    distance_m = std::max(distance_m, clip.distance_m);
  }
  if (names.empty()) return std::nullopt;
  return Root{{Severity::unusable,
               {Subject::Part::clips, std::move(names)},
               found::TrackInUnit{distance_m, likely_unit(distance_m, kUsualRun_m)}},
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
