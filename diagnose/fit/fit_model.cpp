#include "diagnose/fit/fit_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "diagnose/fit/drag_of_air.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

// No misfit, however large, makes a K that Stokes' law excludes, a gravity that no place on Earth has, or a slope of a
// fall.
constexpr double kMostStokes = 3.0, kMostGravity_sd = 3.0, kMostFall_sd = 3.0;
constexpr double kFarthest_m = 1e9;    // no track is longer
constexpr double kOfOneGram = 1000.0;  // what falls may weigh a gram, where 1 kg is assumed
// A Maxwell wheel, a ring of radius R on an axle of radius r, has (R/r)² times its mass: 65 mm and 3 mm.
constexpr double kMostWheel = 500.0;
// The shift at the ends of the range, relative to their distance from its middle: a wide-angle lens; at a third the
// image folds over.
constexpr double kMostBulge = 0.25;
constexpr double kFewestTurns = 2.0;    // periods in the longest motion: anything slower is a drift, which has other
                                        // causes too
constexpr double kFastest = 0.48;       // as a fraction of the frame rate
constexpr double kFastestLossy = 0.2;   // the same after a codec, which takes two to four frames together, each group
                                        // with its own error
constexpr double kLatestRelease = 0.4;  // fraction of the longest motion: anything later is not at the start
constexpr double kFewFrames = 3.0;
constexpr double kReachOfHand_m = 0.15;  // a hand does not follow a body that falls further
constexpr double kShortestPush = 4.0;    // frames: a push that ends earlier is an error of single frames

ParameterRange range_of_waves(const TrackSet& set) {
  double longest = 0.0, rate = std::numeric_limits<double>::infinity();
  for (const TrackedMotion& motion : set.motions) {
    const double span = motion.t_s.back() - motion.t_s.front();
    longest = std::max(longest, span);
    rate = std::min(rate, static_cast<double>(motion.t_s.size() - 1) / span);
  }
  return {kFewestTurns / longest, (set.lossy ? kFastestLossy : kFastest) * rate};
}

/// Until when a motion is within a hand's reach of its start.
double time_within_reach(const TrackedMotion& motion) {
  const auto beyond = std::find_if(motion.x_m.begin(), motion.x_m.end(),
                                   [&](double x) { return std::abs(x - motion.x_m.front()) > kReachOfHand_m; });
  return beyond == motion.x_m.end() ? motion.t_s.back()
                                    : motion.t_s[static_cast<std::size_t>(beyond - motion.x_m.begin())];
}

}  // namespace

bool begins_with_its_clip(const TrackSet& set, const TrackedMotion& motion) {
  return motion.t_s.front() <= kFewFrames / set.clips[motion.clip].frame_rate_hz;
}

double least_filmed_jitter_s(double top_px_s) {
  constexpr double kShortExposure_s = 1e-3, kPixelError_px = 0.015;
  return std::max(0.01 * kShortExposure_s, top_px_s > 0.0 ? kPixelError_px / top_px_s : 0.0);
}

bool is_at_end(const ParameterRange& range, double value, double absent) {
  const double near = 1e-6 * (range.high - range.low);
  if (!std::isfinite(near) || !(near > 0.0)) return false;
  const auto at = [&](double end) { return std::abs(value - end) <= near && std::abs(end - absent) > near; };
  return at(range.high) || at(range.low);
}

ParameterRange range_of_places(const TrackSet& set) {
  ParameterRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const TrackedMotion& motion : set.motions) {
    for (const double x : motion.x_m) range = {std::min(range.low, x), std::max(range.high, x)};
  }
  return range;
}

ParameterRange range_of(const TrackSet& set, const EffectParameter& parameter, const std::vector<std::size_t>& beside) {
  if (parameter.reach == Reach::places) return range_of_places(set);
  if (parameter.reach == Reach::waves) return range_of_waves(set);
  ParameterRange range{parameter.low, parameter.high};
  if (parameter.reach == Reach::release) {
    double longest = 0.0, frame = 0.0, within_reach = 0.0;
    for (const TrackedMotion& motion : set.motions) {
      if (!begins_with_its_clip(set, motion)) continue;
      longest = std::max(longest, motion.t_s.back());
      within_reach = std::max(within_reach, time_within_reach(motion));
      frame = std::max(frame, 1.0 / set.clips[motion.clip].frame_rate_hz);
    }
    if (longest > 0.0) {
      range.low = kShortestPush * frame;
      range.high = std::max(range.low, std::min(parameter.high, kLatestRelease * longest));
      if (only_falls(set)) range.high = std::max(range.low, std::min(range.high, within_reach));
    }
  }
  if (parameter.reach == Reach::bulge) {
    const ParameterRange places = range_of_places(set);
    const double half_m = 0.5 * (places.high - places.low), most_1_m2 = kMostBulge / (half_m * half_m);
    range = {std::min(range.low, -most_1_m2), std::max(range.high, most_1_m2)};
  }
  if (parameter.reach == Reach::held_speed) range.low = std::max(range.low, set.held_m_s);
  double heaviest_kg = 0.0;
  for (const TrackedMass& mass : set.masses) heaviest_kg = std::max(heaviest_kg, mass.mass_kg);
  const bool with_mass = parameter.reach == Reach::with_mass || parameter.reach == Reach::inertia;
  if (with_mass) range.high *= std::max(1.0, heaviest_kg);
  if (with_mass && set.mass_assumed && only_falls(set)) range.high *= kOfOneGram;
  if (parameter.reach == Reach::per_clip && set.clips.size() > 1) {
    range.low = std::max(range.low, -1.0 / static_cast<double>(set.clips.size() - 1));  // the last clip has none
  }
  if (parameter.reach == Reach::inertia && only_falls(set)) {
    const bool of_air = set.through_air && holds_drag(set, beside);
    range.high = of_air ? std::min(range.high, kMostAirAlong_masses * lightest_kg(set)) : kMostWheel * heaviest_kg;
  }
  return range;
}

namespace {

using Global = ParameterLayout::Global;

}  // namespace

std::size_t free_parameters(const TrackSet& set, const std::vector<std::size_t>& effects) {
  std::size_t count = only_falls(set) ? 1 : 2 + set.groups.size();
  count += 2 * std::max<std::size_t>(1, set.motions.size());
  if (holds_drag(set, effects)) --count;
  for (const std::size_t e : effects) {
    for (const EffectParameter& parameter : effect_list()[e].parameters) {
      if (parameter.only_filmed && !set.images) continue;
      const bool one_kind = effect_list()[e].search == Search::spread;
      count += parameter.each == Each::motion ? set.motions.size() : 1;
      if (one_kind) break;
    }
  }
  return count;
}

bool touches(const TrackSet& set, const Global& global, std::size_t motion) {
  const TrackedMotion& of = set.motions[motion];
  if (global.kind == Global::Kind::alpha) return of.group == global.index;
  if (global.kind == Global::Kind::mass) return of.mass == global.index;
  if (global.kind == Global::Kind::mode) return global.index < of.shared_m.size() && !of.shared_m[global.index].empty();
  if (global.kind == Global::Kind::scale) return of.scale_sd > 0.0;
  if (global.kind != Global::Kind::effect) return true;
  if (global.parameter->each == Each::configuration) return global.configuration == Configuration{of.group, of.mass};
  if (global.parameter->each == Each::clip) return global.index == of.clip;
  return true;
}

std::vector<Configuration> configurations_of(const TrackSet& set) {
  std::set<Configuration> configurations;
  for (const TrackedMotion& motion : set.motions) configurations.insert({motion.group, motion.mass});
  return {configurations.begin(), configurations.end()};
}

ParameterLayout::ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects)
    : effects_(std::move(effects)), configurations_(configurations_of(set)), places_(range_of_places(set)) {
  std::set<std::size_t> clips;
  for (const TrackedMotion& motion : set.motions) clips.insert(motion.clip);
  clips_.assign(clips.begin(), clips.end());
  add_common(set);
  for (const std::size_t effect : effects_) add_effect(set, effect);
}

ParameterLayout::ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects, const ParameterLayout& like)
    : effects_(std::move(effects)), configurations_(like.configurations_), clips_(like.clips_), places_(like.places_) {
  add_common(set);
  for (const std::size_t effect : effects_) add_effect(set, effect);
}

void ParameterLayout::add_common(const TrackSet& set) {
  using Kind = Global::Kind;
  const double open = std::numeric_limits<double>::infinity(),
               held = set.no_drag ? 0.0 : kMostStokes * kStokesDrag_n_s_m;
  globals_.push_back({Kind::k, 0, nullptr, 0, 0.0, {-open, open}});
  if (holds_drag(set, effects_)) globals_.back().range = {0.0, held};
  globals_.push_back({Kind::mu});
  for (std::size_t g = 0; g < set.groups.size(); ++g) {
    globals_.push_back({Kind::alpha, g, nullptr, 0, 0.0, {-open, open}});
    if (!is_fall(set.groups[g])) continue;
    double sd_rad = kFallInclination_rad;
    for (const InclineStatement& s : set.groups[g].statements) sd_rad = std::max(sd_rad, s.sd_rad);
    globals_.back().range = {set.groups[g].stated_rad - kMostFall_sd * sd_rad,
                             set.groups[g].stated_rad + kMostFall_sd * sd_rad};
  }
  if (gravity_matters(set))
    globals_.push_back({Kind::gravity, 0, nullptr, 0, 0.0, {-kMostGravity_sd, kMostGravity_sd}});
  for (std::size_t m = 0; m < set.masses.size(); ++m) {
    if (set.masses[m].sd_kg > 0.0) globals_.push_back({Kind::mass, m});
  }
  for (std::size_t m = 0; m < set.modes; ++m) globals_.push_back({Kind::mode, m});
  const bool scale =
      std::any_of(set.motions.begin(), set.motions.end(), [](const auto& m) { return m.scale_sd > 0.0; });
  if (scale) globals_.push_back({Kind::scale});
}

void ParameterLayout::add_effect(const TrackSet& set, std::size_t effect) {
  for (const EffectParameter& parameter : effect_list()[effect].parameters) {
    if (parameter.only_filmed && !set.images) continue;
    Global global{Global::Kind::effect, 0, &parameter, effect, parameter.step, range_of(set, parameter, effects_)};
    switch (parameter.each) {
      case Each::experiment:
        globals_.push_back(global);
        break;
      case Each::configuration:
        for (const Configuration& configuration : configurations_) {
          global.configuration = configuration;
          globals_.push_back(global);
        }
        break;
      case Each::clip:
        for (const std::size_t clip : clips_) {
          global.index = clip;
          globals_.push_back(global);
        }
        break;
      case Each::motion:
        own_.push_back(&parameter);
        break;
    }
  }
}

void ParameterLayout::widen_to(const Eigen::VectorXd& start) {
  for (std::size_t g = 0; g < globals_.size(); ++g) {
    ParameterRange& range = globals_[g].range;
    const double at = start[static_cast<Eigen::Index>(g)];
    if (globals_[g].kind == Global::Kind::effect) range = {std::min(range.low, at), std::max(range.high, at)};
  }
}

std::size_t ParameterLayout::first_of(std::size_t effect) const {
  for (std::size_t g = 0; g < globals_.size(); ++g) {
    if (globals_[g].kind == Global::Kind::effect && globals_[g].effect == effect) return g;
  }
  return globals_.size();
}

std::vector<std::size_t> ParameterLayout::all_of(const EffectSlot& slot) const {
  std::vector<std::size_t> found;
  for (std::size_t g = 0; g < globals_.size(); ++g) {
    if (globals_[g].parameter != nullptr && globals_[g].parameter->slot == slot) found.push_back(g);
  }
  return found;
}

TrackModel model_of(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const UnnamedForce* unnamed) {
  const TrackedMotion& data = set.motions[motion];
  TrackModel model;
  model.mass_kg = set.masses[data.mass].mass_kg;
  model.gravity_m_s2 = set.gravity_m_s2;
  model.x_mid_m = set.groups[data.group].x_mid_m;
  model.x_mid_all_m = set.x_mid_m;
  model.x_low_m = layout.places().low;
  model.x_high_m = layout.places().high;
  model.clip = data.clip;
  model.known = data.known.t_s.empty() ? nullptr : &data.known;
  model.unnamed = unnamed;
  model.row_px = data.row_px;
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const Global& global = layout.globals()[g];
    const double value = at.global[static_cast<Eigen::Index>(g)];
    if (!touches(set, global, motion)) continue;
    if (global.kind == Global::Kind::k) model.k_n_s_m = value;
    if (global.kind == Global::Kind::mu) model.mu = value;
    if (global.kind == Global::Kind::alpha) model.alpha_rad = value;
    if (global.kind == Global::Kind::gravity) model.gravity_m_s2 += value * set.gravity_sd_m_s2;
    if (global.kind == Global::Kind::mass) model.mass_kg += value * set.masses[global.index].sd_kg;
    if (global.kind == Global::Kind::effect) model.effects[global.parameter->slot] = value;
  }
  model.x0_m = at.own[motion][0];
  model.v0_m_s = at.own[motion][1];
  for (std::size_t o = 0; o < layout.own().size(); ++o) {
    model.effects[layout.own()[o]->slot] = at.own[motion][static_cast<Eigen::Index>(2 + o)];
  }
  return model;
}

std::vector<double> shared_errors(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at,
                                  std::size_t motion, const std::vector<double>& x_m) {
  const TrackedMotion& data = set.motions[motion];
  std::vector<double> shared(x_m.size(), 0.0);
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const Global& global = layout.globals()[g];
    if (!touches(set, global, motion)) continue;
    const double c = at.global[static_cast<Eigen::Index>(g)];
    for (std::size_t p = 0; p < shared.size(); ++p) {
      if (global.kind == Global::Kind::mode) shared[p] += c * data.shared_m[global.index][p];
      if (global.kind == Global::Kind::scale) shared[p] += c * data.scale_sd * x_m[p];
    }
  }
  return shared;
}

namespace {

using Global = ParameterLayout::Global;

/// The change of each parameter for a finite difference.
double step_of(const Global& global, double at) {
  switch (global.kind) {
    case Global::Kind::k:
      return 1e-5 * std::max(0.05, std::abs(at));
    case Global::Kind::mu:
    case Global::Kind::alpha:
      return 1e-6;
    case Global::Kind::mass:
      return 1e-3;
    case Global::Kind::effect:
      return global.step;
    default:
      return 1e-3;
  }
}

Moved moved(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t i,
            const Lateness& late) {
  const TrackModel model = model_of(set, layout, at, i);
  return move(model, set.motions[i].t_s, late.empty() ? std::span<const double>() : std::span(late[i]));
}

/// Whether a motion stays where a motion can be. Where the drag drives it, it runs off as exp(|K| t/m), and what is
/// still a number overflows in squares.
bool is_followed(const std::vector<double>& x_m) {
  return std::all_of(x_m.begin(), x_m.end(), [](double x) { return std::abs(x) < kFarthest_m; });
}

}  // namespace

std::vector<double> weights_of(const TrackedMotion& motion) {
  std::vector<double> weights(motion.t_s.size());
  for (std::size_t p = 0; p < weights.size(); ++p) weights[p] = motion.outlier[p] ? 0.0 : 1.0 / motion.sd_of(p);
  return weights;
}

FitMotion linearise(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t i,
                    const Lateness& late, Derivatives derivatives) {
  const TrackedMotion& data = set.motions[i];
  const auto n = static_cast<Eigen::Index>(data.t_s.size());
  FitMotion of;
  Moved base = moved(set, layout, at, i, late);
  of.x_m = std::move(base.x_m);
  of.v_m_s = std::move(base.v_m_s);
  const std::vector<double> shared = shared_errors(set, layout, at, i, of.x_m), weight = weights_of(data);
  of.plain.resize(n);
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto q = static_cast<std::size_t>(p);
    of.plain[p] = weight[q] * (data.x_m[q] - of.x_m[q] - shared[q]);
  }
  of.residual = whitened(data, of.plain);
  if (derivatives != Derivatives::none) add_derivatives(set, layout, at, i, late, derivatives, of);
  return of;
}

void add_derivatives(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t i,
                     const Lateness& late, Derivatives derivatives, FitMotion& of) {
  const TrackedMotion& data = set.motions[i];
  const auto n = static_cast<Eigen::Index>(data.t_s.size());
  const auto& globals = layout.globals();
  const std::vector<double>& base_m = of.x_m;
  const std::vector<double> weight = weights_of(data);
  of.global = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(globals.size()));
  of.own = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(2 + layout.own().size()));
  FitPoint near = at;
  const bool central = derivatives == Derivatives::central;
  // Beside parameters with which the motion cannot be followed, the derivative is that towards the other side; it is 0
  // if neither side can be followed.
  const auto fill = [&](double& parameter, double step, auto column) {
    const double kept = parameter;
    parameter = kept + step;
    const Moved above = moved(set, layout, near, i, late);
    const bool has_above = is_followed(above.x_m);
    Moved below;
    if (central || !has_above) {
      parameter = kept - step;
      below = moved(set, layout, near, i, late);
    }
    parameter = kept;
    const bool has_below = (central || !has_above) && is_followed(below.x_m);
    const double apart = (has_above ? step : 0.0) + (has_below ? step : 0.0);
    if (apart == 0.0) return;
    const std::vector<double>&high = has_above ? above.x_m : base_m, &low = has_below ? below.x_m : base_m;
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto q = static_cast<std::size_t>(p);
      column[p] = weight[q] * (high[q] - low[q]) / apart;
    }
  };
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (!touches(set, globals[g], i)) continue;
    const auto column = static_cast<Eigen::Index>(g);
    if (globals[g].kind == Global::Kind::mode || globals[g].kind == Global::Kind::scale) {
      for (Eigen::Index p = 0; p < n; ++p) {
        const auto q = static_cast<std::size_t>(p);
        of.global(p, column) = weight[q] * (globals[g].kind == Global::Kind::mode ? data.shared_m[globals[g].index][q]
                                                                                  : data.scale_sd * base_m[q]);
      }
      continue;
    }
    fill(near.global[column], step_of(globals[g], near.global[column]), of.global.col(column));
  }
  const bool shifts = is_followed(base_m) && shifts_as_a_whole(model_of(set, layout, at, i));
  if (shifts) of.own.col(0) = Eigen::Map<const Eigen::VectorXd>(weight.data(), n);
  for (Eigen::Index o = shifts ? 1 : 0; o < of.own.cols(); ++o) {
    fill(near.own[i][o], o < 2 ? 1e-6 : layout.own()[static_cast<std::size_t>(o - 2)]->step, of.own.col(o));
  }
  of.global = whitened(data, std::move(of.global));
  of.own = whitened(data, std::move(of.own));
}

}  // namespace glidelab::diagnose
