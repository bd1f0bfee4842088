#include "diagnose/next/next_changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace glidelab::diagnose {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSlowest = 0.2;               // launch that is suggested, of the fastest one that there is
constexpr double kPlumb_rad = 0.05 * kDegree;  // a thread in the picture, or a digital level
constexpr double kRuler_m = 5e-4;              // half a division of a ruler in millimetres
constexpr double kStopWatch_s = 10.0;          // that it is filmed for: known to a frame
constexpr double kLevel_rad = 0.5 * kDegree;
constexpr double kTilt_rad = 4.0 * kDegree;  // where there is a level track only
constexpr double kSteeper = 1.5;

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

std::string launch_words(double v_m_s) {
  return fmt::format("Record a launch {} at {:.2g} m/s", v_m_s < 0.0 ? "uphill" : "downhill", std::abs(v_m_s));
}

std::string on_set_up(const TrackSet& set, std::size_t group) {
  return set.groups.size() > 1 ? fmt::format(" on set-up \"{}\"", set.groups[group].name) : std::string();
}

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

Change clip_of(Change::Kind kind, std::string words, const NextClip& clip) {
  Change change;
  change.kind = kind;
  change.words = std::move(words);
  change.clip = clip;
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
          changes.push_back(
              clip_of(is_new ? Change::Kind::mass : Change::Kind::launch,
                      fmt::format("{}{} with {}{:.0f} g", launch_words(direction * v), on_set_up(set, group),
                                  is_new ? "the mass changed to " : "", 1000.0 * mass),
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
  std::vector<std::pair<double, std::string>> tracks;
  if (flattest > kLevel_rad) tracks.emplace_back(0.0, "made level");
  const double tilted = std::abs(steepest) > kLevel_rad ? kSteeper * steepest : kTilt_rad;
  tracks.emplace_back(tilted, fmt::format("tilted to {:.1f}°", tilted / kDegree));
  for (const auto& [alpha, words] : tracks) {
    for (const double v : {-so.fast_m_s, so.fast_m_s}) {
      for (const double mass : distinct({so.light_kg, so.heavy_kg})) {
        Change change = clip_of(Change::Kind::inclination,
                                fmt::format("{} with {:.0f} g on the track {}", launch_words(v), 1000.0 * mass, words),
                                {set.groups.size(), mass, v, so.rate_hz});
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
        const std::string again =
            fmt::format("{}{} with {:.0f} g", launch_words(v), on_set_up(set, group), 1000.0 * mass);
        for (const double times : {2.0, 0.5}) {
          changes.push_back(clip_of(
              Change::Kind::frame_rate,
              fmt::format("{} at {:.4g} frames a second instead of {:.4g}", again, times * so.rate_hz, so.rate_hz),
              {group, mass, v, times * so.rate_hz}));
        }
        if (!set.pictures || !scatters) continue;
        changes.push_back(clip_of(Change::Kind::exposure, again + " with half the exposure (it halves the blur)",
                                  {group, mass, v, so.rate_hz, 0.5}));
      }
    }
  }
}

void add_statements(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  for (const std::size_t group : so.groups) {
    const auto& known = set.groups[group].statements;
    if (std::any_of(known.begin(), known.end(), [](const auto& s) { return s.against == "plumb"; })) continue;
    Change plumb;
    plumb.kind = Change::Kind::plumb;
    plumb.words = fmt::format("Film a plumb line{} (it states the inclination to {:.2g}°)", on_set_up(set, group),
                              kPlumb_rad / kDegree);
    plumb.statements = {{NextStatement::Of::inclination, group, 0.0, 0.0, kPlumb_rad}};
    changes.push_back(std::move(plumb));
  }
  const ParameterRange places = range_of_places(set);
  const double middle = 0.5 * (places.low + places.high);
  Change pattern;
  pattern.kind = Change::Kind::pattern;
  pattern.words = fmt::format(
      "Lay the pattern (or a ruler) in the plane of motion on either half of the track, and compare its length there "
      "({:.1f} mm in {:.2g} m)",
      1000.0 * kRuler_m, middle - places.low);
  pattern.statements = {{NextStatement::Of::length, 0, places.low, middle, kRuler_m},
                        {NextStatement::Of::length, 0, middle, places.high, kRuler_m}};
  changes.push_back(std::move(pattern));
  Change clock;
  clock.kind = Change::Kind::clock;
  clock.words = fmt::format("Film a running stop-watch for {:.0f} s (it shows the frame rate)", kStopWatch_s);
  clock.statements = {{NextStatement::Of::clock, 0, 0.0, 0.0, 1.0 / (kStopWatch_s * so.rate_hz)}};
  changes.push_back(std::move(clock));
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

std::string kinds_in_words(const std::vector<Change>& changes) {
  using Kind = Change::Kind;
  static const std::array<std::pair<Kind, const char*>, 8> kWords = {{{Kind::launch, "launches"},
                                                                      {Kind::mass, "masses"},
                                                                      {Kind::inclination, "inclinations"},
                                                                      {Kind::frame_rate, "frame rates"},
                                                                      {Kind::exposure, "exposures"},
                                                                      {Kind::plumb, "a plumb view"},
                                                                      {Kind::pattern, "a pattern check"},
                                                                      {Kind::clock, "a stop-watch"}}};
  std::string text;
  for (const auto& [kind, words] : kWords) {
    const bool any = std::any_of(changes.begin(), changes.end(), [of = kind](const auto& c) { return c.kind == of; });
    if (any) text += (text.empty() ? "" : ", ") + std::string(words);
  }
  return text;
}

}  // namespace glidelab::diagnose
