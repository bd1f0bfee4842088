#include "diagnose/next/next_changes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>

namespace glidelab::diagnose {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSlowest = 0.2;               // of the fastest launch so far: no slower one is suggested
constexpr double kPlumb_rad = 0.05 * kDegree;  // standard deviation of a thread in the image, or a digital level
constexpr double kRuler_m = 5e-4;              // half a division of a ruler in millimetres
constexpr double kStopWatch_s = 10.0;          // for which a stopwatch is filmed: known to a frame
constexpr double kLevel_rad = 0.5 * kDegree;   // a track that is less inclined counts as level
constexpr double kTilt_rad = 4.0 * kDegree;    // that is suggested where there is a level track only
constexpr double kSteeper = 1.5;               // times the steepest inclination so far

/// What there is so far.
struct SoFar {
  double slow_m_s = 1e9, fast_m_s = 0.0, rate_hz = 0.0, light_kg = 1e9, heavy_kg = 0.0;
  std::vector<std::size_t> groups;  // the flattest and the steepest
};

SoFar so_far(const TrackSet& set, const MotionFit& fit) {
  SoFar so;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const double v = std::abs(fit.at.own[i][1]), mass = set.masses[set.motions[i].mass].mass_kg;
    so.slow_m_s = std::min(so.slow_m_s, v);
    so.fast_m_s = std::max(so.fast_m_s, v);
    so.rate_hz = std::max(so.rate_hz, set.clips[set.motions[i].clip].frame_rate_hz);
    so.light_kg = std::min(so.light_kg, mass);
    so.heavy_kg = std::max(so.heavy_kg, mass);
  }
  const auto steepness = [&](std::size_t g) { return std::abs(set.groups[g].stated_rad); };
  std::size_t flat = 0, steep = 0;
  for (std::size_t g = 1; g < set.groups.size(); ++g) {
    if (steepness(g) < steepness(flat)) flat = g;
    if (steepness(g) > steepness(steep)) steep = g;
  }
  so.groups = {flat};
  if (steep != flat) so.groups.push_back(steep);
  return so;
}

/// The set-up's name, where there are several.
std::string name_among(const TrackSet& set, std::size_t group) {
  return set.groups.size() > 1 ? set.groups[group].name : std::string();
}

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Of a new set-up where the clip's group is beyond those that there are.
Change clip_of(ChangeKind kind, const TrackSet& set, const SoFar& so, const NextClip& clip) {
  Change change;
  change.kind = kind;
  change.clip = clip;
  if (clip.group < set.groups.size()) change.on = name_among(set, clip.group);
  change.rate_so_far_hz = so.rate_hz;
  return change;
}

void add_launches(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  // Where a motion was released, half of the slowest launch is no launch.
  const double slow = std::max(0.5 * so.slow_m_s, kSlowest * so.fast_m_s);
  for (const std::size_t group : so.groups) {
    for (const double direction : {-1.0, 1.0}) {
      for (const double v : distinct({slow, so.fast_m_s, 1.8 * so.fast_m_s})) {
        for (const double mass : distinct({so.light_kg, so.heavy_kg, 1.6 * so.heavy_kg, 0.6 * so.light_kg})) {
          const bool is_new = mass != so.light_kg && mass != so.heavy_kg;
          changes.push_back(clip_of(is_new ? ChangeKind::mass : ChangeKind::launch, set, so,
                                    {group, mass, direction * v, so.rate_hz}));
        }
      }
    }
  }
}

void add_inclinations(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  const double flattest = std::abs(set.groups[so.groups.front()].stated_rad);
  const double steepest = set.groups[so.groups.back()].stated_rad;
  double sd = 0.0;  // as well as inclinations are stated so far
  for (const TrackGroup& group : set.groups) {
    for (const InclineStatement& statement : group.statements) sd = std::max(sd, statement.sd_rad);
  }
  std::vector<double> inclinations;
  if (flattest > kLevel_rad) inclinations.push_back(0.0);
  inclinations.push_back(std::abs(steepest) > kLevel_rad ? kSteeper * steepest : kTilt_rad);
  for (const double alpha : inclinations) {
    for (const double v : {-so.fast_m_s, so.fast_m_s}) {
      for (const double mass : distinct({so.light_kg, so.heavy_kg})) {
        Change change = clip_of(ChangeKind::inclination, set, so, {set.groups.size(), mass, v, so.rate_hz});
        change.set_up = NextSetUp{alpha, sd};
        changes.push_back(std::move(change));
      }
    }
  }
}

/// The launches there are with another frame rate, and with half the exposure.
void add_settings(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  const bool scatters = set.position_noise
                            ? set.position_noise->shape.jitter_s > 0.0
                            : std::any_of(set.motions.begin(), set.motions.end(),
                                          [](const TrackedMotion& motion) { return !motion.wider.empty(); });
  for (const std::size_t group : so.groups) {
    for (const double v : {-so.fast_m_s, so.fast_m_s}) {
      for (const double mass : distinct({so.light_kg, so.heavy_kg})) {
        for (const double times : {2.0, 0.5}) {
          changes.push_back(clip_of(ChangeKind::frame_rate, set, so, {group, mass, v, times * so.rate_hz}));
        }
        if (!set.pictures || !scatters) continue;
        changes.push_back(clip_of(ChangeKind::exposure, set, so, {group, mass, v, so.rate_hz, 0.5}));
      }
    }
  }
}

void add_statements(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  const auto add = [&](ChangeKind kind, const std::string& on, const std::vector<NextStatement>& statements) {
    Change& change = changes.emplace_back();
    change.kind = kind;
    change.statements = statements;
    change.on = on;
    change.rate_so_far_hz = so.rate_hz;
  };
  for (const std::size_t group : so.groups) {
    const auto& known = set.groups[group].statements;
    if (std::any_of(known.begin(), known.end(), [](const auto& s) { return s.against == "plumb"; })) continue;
    add(ChangeKind::plumb, name_among(set, group), {{NextStatement::Of::inclination, group, 0.0, 0.0, kPlumb_rad}});
  }
  const ParameterRange places = range_of_places(set);
  const double middle = 0.5 * (places.low + places.high);
  add(ChangeKind::pattern, "",
      {{NextStatement::Of::length, 0, places.low, middle, kRuler_m},
       {NextStatement::Of::length, 0, middle, places.high, kRuler_m}});
  add(ChangeKind::clock, "", {{NextStatement::Of::clock, 0, 0.0, 0.0, 1.0 / (kStopWatch_s * so.rate_hz)}});
}

}  // namespace

std::vector<Change> feasible_changes(const TrackSet& set, const MotionFit& nominal) {
  const SoFar so = so_far(set, nominal);
  std::vector<Change> changes;
  add_launches(set, so, changes);
  add_inclinations(set, so, changes);
  add_settings(set, so, changes);
  add_statements(set, so, changes);
  return changes;
}

ChangesWeighed weighed(const std::vector<Change>& changes) {
  std::set<ChangeKind> kinds;
  for (const Change& change : changes) kinds.insert(change.kind);
  return {changes.size(), {kinds.begin(), kinds.end()}};
}

}  // namespace glidelab::diagnose
