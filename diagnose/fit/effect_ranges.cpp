#include "diagnose/fit/effect_ranges.h"

#include <algorithm>
#include <limits>

namespace glidelab::diagnose {
namespace {

constexpr double kFewestTurns = 2.0;    // in the longest motion: slower is a drift, which other causes make as well
constexpr double kFastest = 0.48;       // of the frame rate
constexpr double kFastestLossy = 0.2;   // a codec takes frames by twos to fours, each with its own error
constexpr double kLatestRelease = 0.4;  // of the longest motion: later it is no start
constexpr double kFewFrames = 3.0;
constexpr double kShortestPush = 4.0;  // frames: one that ends before that is an error of single frames

ParameterRange range_of_waves(const TrackSet& set) {
  double longest = 0.0, rate = std::numeric_limits<double>::infinity();
  for (const TrackedMotion& motion : set.motions) {
    const double span = motion.t_s.back() - motion.t_s.front();
    longest = std::max(longest, span);
    rate = std::min(rate, static_cast<double>(motion.t_s.size() - 1) / span);
  }
  return {kFewestTurns / longest, (set.lossy ? kFastestLossy : kFastest) * rate};
}

}  // namespace

bool begins_with_its_clip(const TrackSet& set, const TrackedMotion& motion) {
  return motion.t_s.front() <= kFewFrames / set.clips[motion.clip].frame_rate_hz;
}

ParameterRange range_of_places(const TrackSet& set) {
  ParameterRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const TrackedMotion& motion : set.motions) {
    for (const double x : motion.x_m) range = {std::min(range.low, x), std::max(range.high, x)};
  }
  return range;
}

ParameterRange range_of(const TrackSet& set, const EffectParameter& parameter) {
  if (parameter.reach == Reach::places) return range_of_places(set);
  if (parameter.reach == Reach::waves) return range_of_waves(set);
  ParameterRange range{parameter.low, parameter.high};
  if (parameter.reach == Reach::release) {
    double longest = 0.0, frame = 0.0;
    for (const TrackedMotion& motion : set.motions) {
      if (!begins_with_its_clip(set, motion)) continue;
      longest = std::max(longest, motion.t_s.back());
      frame = std::max(frame, 1.0 / set.clips[motion.clip].frame_rate_hz);
    }
    if (longest > 0.0) range = {kShortestPush * frame, kLatestRelease * longest};
  }
  if (parameter.reach == Reach::held_speed) range.low = std::max(range.low, set.held_m_s);
  if (parameter.reach == Reach::with_mass) {
    double heaviest_kg = 1.0;
    for (const TrackedMass& mass : set.masses) heaviest_kg = std::max(heaviest_kg, mass.mass_kg);
    range.high *= heaviest_kg;
  }
  return range;
}

}  // namespace glidelab::diagnose
