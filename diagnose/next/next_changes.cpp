#include "diagnose/next/next_changes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/math/angles.h"
#include "diagnose/tracks/tracked_motions.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr double kSlowest = 0.2;  // of the fastest launch so far: no slower one is suggested
constexpr double kPlumb_rad =
    0.05 * base::kRadPerDegree;        // standard deviation of a thread in the image, or a digital level
constexpr double kRuler_m = 5e-4;      // half a division of a ruler in millimetres
constexpr double kStopWatch_s = 10.0;  // duration for which a stopwatch is filmed: known to a frame
constexpr double kLevel_rad = 0.5 * base::kRadPerDegree;  // a track with a smaller inclination counts as level
constexpr double kTilt_rad = 4.0 * base::kRadPerDegree;   // that is suggested if there is only a level track
constexpr double kSteeper = 1.5;                          // times the steepest inclination so far

/// The experiment so far.
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

/// The set-up's name, if there are several.
std::string name_among(const TrackSet& set, std::size_t group) {
  return set.groups.size() > 1 ? set.groups[group].name : std::string();
}

std::vector<double> distinct(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// The sign of x downhill; 0 for a track that counts as level.
int downhill_at(double alpha_rad) {
  return std::abs(alpha_rad) <= kLevel_rad ? 0 : alpha_rad > 0.0 ? 1 : -1;
}

/// For a new set-up if the clip's group is beyond the existing ones.
Change clip_of(ChangeKind kind, const TrackSet& set, const SoFar& so, const NextClip& clip) {
  Change change;
  change.kind = kind;
  change.clip = clip;
  change.falls = only_falls(set);
  if (clip.group < set.groups.size()) {
    change.on = name_among(set, clip.group);
    change.downhill = downhill_at(set.groups[clip.group].stated_rad);
  }
  change.rate_so_far_hz = so.rate_hz;
  change.mass_assumed = set.mass_assumed;
  return change;
}

/// If a motion was released, half of the slowest launch is not a launch.
double slowest_launch(const SoFar& so) {
  return std::max(0.5 * so.slow_m_s, kSlowest * so.fast_m_s);
}

/// Falling gliders are dropped: other masses, from where the slowest of them began.
void add_drops(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  for (const std::size_t group : so.groups) {
    for (const double mass : distinct({so.light_kg, so.heavy_kg, 1.6 * so.heavy_kg, 0.6 * so.light_kg})) {
      const bool is_new = mass != so.light_kg && mass != so.heavy_kg;
      changes.push_back(clip_of(is_new ? ChangeKind::mass : ChangeKind::launch, set, so,
                                {group, mass, slowest_launch(so), so.rate_hz}));
    }
  }
}

void add_launches(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  const double slow = slowest_launch(so);
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
        change.downhill = downhill_at(alpha);
        changes.push_back(std::move(change));
      }
    }
  }
}

/// The launches so far with another frame rate, and with half the exposure.
void add_settings(const TrackSet& set, const SoFar& so, std::vector<Change>& changes) {
  const bool scatters = set.position_noise
                            ? set.position_noise->shape.jitter_s > 0.0
                            : std::any_of(set.motions.begin(), set.motions.end(),
                                          [](const TrackedMotion& motion) { return !motion.wider.empty(); });
  const std::vector<double> speeds =
      only_falls(set) ? std::vector{slowest_launch(so)} : std::vector{-so.fast_m_s, so.fast_m_s};
  for (const std::size_t group : so.groups) {
    for (const double v : speeds) {
      for (const double mass : distinct({so.light_kg, so.heavy_kg})) {
        for (const double times : {2.0, 0.5}) {
          changes.push_back(clip_of(ChangeKind::frame_rate, set, so, {group, mass, v, times * so.rate_hz}));
        }
        if (!set.images || !scatters) continue;
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
    if (std::any_of(known.begin(), known.end(), [](const auto& s) { return s.against == Against::plumb; })) continue;
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
  if (!is_driven(set)) {  // nobody knows what a motor will do next
    if (only_falls(set)) {
      add_drops(set, so, changes);
    } else {
      add_launches(set, so, changes);
      add_inclinations(set, so, changes);
    }
    add_settings(set, so, changes);
  }
  add_statements(set, so, changes);
  return changes;
}

ChangesWeighed weighed(const std::vector<Change>& changes) {
  std::set<ChangeKind> kinds;
  for (const Change& change : changes) kinds.insert(change.kind);
  return {changes.size(), {kinds.begin(), kinds.end()}};
}

namespace {

constexpr std::size_t kFewestPoints = 12;
constexpr double kInside = 0.05;  // fraction of the range of positions at which a launch begins
constexpr double kMostPoints = 2000.0;

/// Noise of a position as a function of its speed: sd² (1 + c v²).
struct NoiseSoFar {
  double sd_m = 0.0, by_speed_s2_m2 = 0.0;
};

NoiseSoFar noise_so_far(const TrackSet& set, const MotionFit& fit) {
  double squares = 0.0, count = 0.0, excess = 0.0, fast = 0.0;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    const auto n = static_cast<double>(motion.t_s.size());
    squares += n * motion.sd_m * motion.sd_m;
    count += n;
    for (std::size_t p = 0; p < motion.wider.size(); ++p) {
      excess += std::pow(motion.sd_of(p) / motion.own_sd_of(p), 2) - 1.0;
      fast += fit.motions[i].v_m_s[p] * fit.motions[i].v_m_s[p];
    }
  }
  return {std::sqrt(squares / count), fast > 0.0 ? std::max(0.0, excess / fast) : 0.0};
}

/// The motion over the widest range of positions of this set-up, or of all set-ups for a new one: a further clip is
/// filmed in the same way.
const TrackedMotion& like(const TrackSet& set, const Change& change) {
  const TrackedMotion* widest = nullptr;
  double most = -1.0;
  for (const TrackedMotion& motion : set.motions) {
    if (!change.set_up && motion.group != change.clip->group) continue;
    const auto [low, high] = std::minmax_element(motion.x_m.begin(), motion.x_m.end());
    if (*high - *low <= most) continue;
    most = *high - *low;
    widest = &motion;
  }
  return widest != nullptr ? *widest : set.motions.front();
}

/// Interpolates a position-dependent quantity of a motion: between the two positions on either side, and beyond them by
/// the slope of all.
std::vector<double> at_places(const TrackedMotion& motion, const std::vector<double>& of,
                              const std::vector<double>& x_m) {
  std::vector<double> result;
  if (of.size() != motion.x_m.size()) return result;
  std::vector<std::pair<double, double>> known;
  for (std::size_t p = 0; p < of.size(); ++p) known.emplace_back(motion.x_m[p], of[p]);
  std::sort(known.begin(), known.end());
  const auto [first, first_of] = known.front();
  const auto [last, last_of] = known.back();
  const double slope = last > first ? (last_of - first_of) / (last - first) : 0.0;
  for (const double x : x_m) {
    const auto above = std::lower_bound(known.begin(), known.end(), std::pair(x, -1e300));
    if (above == known.begin()) {
      result.push_back(first_of + slope * (x - first));
    } else if (above == known.end()) {
      result.push_back(last_of + slope * (x - last));
    } else {
      const auto& [below_x, below_of] = *(above - 1);
      const double part = above->first > below_x ? (x - below_x) / (above->first - below_x) : 0.0;
      result.push_back(below_of + part * (above->second - below_of));
    }
  }
  return result;
}

/// The set-ups, masses and clips so far and the change's, whose motion is the only one. It is the last clip: what
/// changes from clip to clip goes on.
TrackSet with_clip(const TrackSet& set, const Change& change) {
  const NextClip& clip = *change.clip;
  TrackSet one;
  one.gravity_m_s2 = set.gravity_m_s2;
  one.gravity_sd_m_s2 = gravity_matters(set) ? set.gravity_sd_m_s2 : 0.0;  // the same parameters as so far
  one.groups = set.groups;
  one.masses = set.masses;
  one.x_mid_m = set.x_mid_m;
  one.modes = set.modes;
  one.images = set.images;
  one.through_air = set.through_air;
  one.mass_assumed = set.mass_assumed;
  one.no_drag = set.no_drag;
  one.clips = set.clips;
  one.clips.push_back({"next", clip.rate_hz, 0.0, 0, 0.0});
  if (change.set_up) one.groups.push_back({"next", change.set_up->alpha_rad, {}, set.x_mid_m});
  one.masses.push_back({clip.mass_kg, 0.0});
  TrackedMotion motion;
  motion.clip = set.clips.size();
  motion.group = clip.group;
  motion.mass = one.masses.size() - 1;
  motion.m_per_px = like(set, change).m_per_px;
  double span = 0.0;
  for (const TrackedMotion& other : set.motions) {
    span = std::max(span, other.t_s.back() - other.t_s.front());
    motion.scale_sd = std::max(motion.scale_sd, other.scale_sd);
  }
  const auto frames = static_cast<std::size_t>(std::clamp(span * clip.rate_hz, 20.0, kMostPoints));
  for (std::size_t k = 0; k < frames; ++k) motion.t_s.push_back(static_cast<double>(k) / clip.rate_hz);
  one.motions.push_back(std::move(motion));
  return one;
}

/// The noise as measured, with jitter and blur in proportion to the exposure; white noise grows with the speed as it
/// has so far.
void give_noise(const TrackSet& set, const MotionFit& fit, const Change& change, const Moved& moved,
                TrackedMotion& motion) {
  const NoiseSoFar noise = noise_so_far(set, fit);
  motion.sd_m = noise.sd_m;
  const bool filmed = motion.m_per_px > 0.0;
  if (set.position_noise && !(filmed && motion.along_px.empty()) && !moved.x_m.empty()) {
    NoiseShape shape = set.position_noise->shape;
    shape.jitter_s *= change.clip->exposure;
    whiten(motion, shape, change.clip->rate_hz);
    return;
  }
  const double by_speed = noise.by_speed_s2_m2 * change.clip->exposure * change.clip->exposure;
  if (!(by_speed > 0.0)) return;
  for (const double v : moved.v_m_s) motion.wider.push_back(std::sqrt(1.0 + by_speed * v * v));
}

}  // namespace

Eigen::Index new_alpha(const TrackSet& set) {
  return static_cast<Eigen::Index>(2 + set.groups.size());
}

FitPoint next_point(const TrackSet& set, const MotionFit& fit, const Change& change) {
  const ParameterRange places = range_of_places(set);
  const double inside = kInside * (places.high - places.low), v0 = change.clip->v0_m_s;
  FitPoint at;
  at.global = fit.at.global;
  if (change.set_up) {
    const Eigen::Index behind = fit.at.global.size() - new_alpha(set);
    at.global.resize(fit.at.global.size() + 1);
    at.global << fit.at.global.head(new_alpha(set)), change.set_up->alpha_rad, fit.at.global.tail(behind);
  }
  Eigen::VectorXd own = Eigen::VectorXd::Zero(fit.at.own.front().size());
  for (const Eigen::VectorXd& other : fit.at.own) own += other / static_cast<double>(fit.at.own.size());
  own[0] = v0 < 0.0 ? places.high - inside : places.low + inside;
  own[1] = v0;
  at.own = {std::move(own)};
  return at;
}

NextMotion next_motion(const TrackSet& set, const MotionFit& fit, const Change& change) {
  TrackSet one = with_clip(set, change);
  TrackedMotion& motion = one.motions.front();
  const ParameterLayout layout(one, fit.effects, *fit.layout);
  const FitPoint at = next_point(set, fit, change);
  Moved moved = move(model_of(one, layout, at, 0), motion.t_s);
  const ParameterRange places = range_of_places(set);
  std::size_t points = 0;
  while (points < moved.x_m.size() && moved.x_m[points] >= places.low && moved.x_m[points] <= places.high) ++points;
  if (points < kFewestPoints) points = 0;
  moved.x_m.resize(points);
  moved.v_m_s.resize(points);
  motion.t_s.resize(points);
  motion.x_m = moved.x_m;
  motion.outlier.assign(points, 0);
  // The camera has the same errors, and sees a position at the same pixel.
  const TrackedMotion& so_far = like(set, change);
  motion.row_px = at_places(so_far, so_far.row_px, moved.x_m);
  if (!motion.row_px.empty()) motion.x_m = move(model_of(one, layout, at, 0), motion.t_s).x_m;
  motion.along_px = at_places(so_far, so_far.along_px, moved.x_m);
  for (std::size_t mode = 0; mode < std::min(so_far.shared_m.size(), so_far.first_pixel_mode); ++mode) {
    motion.shared_m.push_back(at_places(so_far, so_far.shared_m[mode], moved.x_m));
  }
  give_noise(set, fit, change, moved, motion);
  const std::vector<double> shared = shared_errors(one, layout, at, 0, moved.x_m);
  for (std::size_t p = 0; p < points; ++p) motion.x_m[p] += shared[p];
  return {std::move(one), std::move(moved)};
}

}  // namespace glidelab::diagnose
