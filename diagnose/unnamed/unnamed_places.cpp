#include "diagnose/unnamed/unnamed_places.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/math/log_sum.h"
#include "core/math/quantile.h"
#include "diagnose/model/turning_waves.h"
#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {
namespace {

constexpr int kSmooth = 5, kCoarse = 12, kFine = 36;  // number of bumps over the range
constexpr double kFewestSwings = 2.0;                 // periods over the whole range: fewer could be any smooth shape
constexpr double kMostPulls = 25.0;                   // periods of a force, which moves the glider less the shorter
                                                      // they are
constexpr double kMostSwings = 600;                   // periods that are tried in full
constexpr double kFinestSwings = 2000;                // periods over the whole range: the pixels of a wide image
constexpr double kLeastCoarseGain = 3.0,
                 kLeastFineGain = 8.0;  // log likelihood above which a wave is tried on a finer grid

struct Ranges {
  Grid x, v, t, speed;
};

Ranges ranges_of(const ScoreSpace& space) {
  Ranges ranges;
  for (std::size_t i = 0; i < space.set().motions.size(); ++i) {
    for (const double x : space.set().motions[i].x_m) ranges.x.add(x);
    for (const double t : space.set().motions[i].t_s) ranges.t.add(t);
    for (const double v : space.fit().motions[i].v_m_s) {
      ranges.v.add(v);
      ranges.speed.add(std::abs(v));
    }
  }
  return ranges;
}

enum class Place { x, v, t };
enum class Force { drive, friction, drag };
enum class Load { none, mass, either };

/// A force f(x, v or t) of any smooth shape; a friction, which reverses with the motion; or a drag, which is
/// proportional to the speed. As a function of speed it depends on |v|, unless it is a driving force. In N, or in
/// proportion to the mass; with more than one mass it may be either.
void add_force(const ScoreSpace& space, const Grid& grid, Place over, GapVariable variable, Force kind, Load load,
               std::vector<UnnamedFamily>& families) {
  const TrackSet& set = space.set();
  std::vector<ScoreColumn> in_n, by_mass;
  for (int b = 0; b < grid.bumps; ++b) {
    const double middle = grid.at(b), width = grid.width();
    const UnnamedForce force = [=](double x, double v, double t) {
      const double of_speed = kind == Force::drive ? v : std::abs(v);
      const double size = bump(over == Place::x ? x : over == Place::t ? t : of_speed, middle, width);
      return kind == Force::drive ? size : kind == Force::drag ? -v * size : v < 0.0 ? -size : size;
    };
    std::vector<Eigen::VectorXd> changes = space.changes_by(std::vector<UnnamedForce>(set.motions.size(), force), 1e-4);
    if (load != Load::mass) in_n.push_back(space.project(changes));
    if (load == Load::none) continue;
    for (std::size_t i = 0; i < changes.size(); ++i) changes[i] *= set.masses[set.motions[i].mass].mass_kg;
    by_mass.push_back(space.project(changes));
  }
  const GapKind what = kind == Force::drive      ? GapKind::force
                       : kind == Force::friction ? GapKind::friction
                                                 : GapKind::viscous_drag;
  if (!in_n.empty()) {
    add_shapes(space, in_n, grid, family_of(variable, what, kind == Force::drag ? "N s/m" : "N"), families);
  }
  if (by_mass.empty()) return;
  add_shapes(space, by_mass, grid, family_of(variable, kind == Force::drive ? GapKind::acceleration : what, "m/s²"),
             families);
}

enum class Seen { over_x, over_t, late };

/// A displacement d(x or t) of any smooth shape, due to the camera; or a delay d(t), due to its clock.
void add_displacement(const ScoreSpace& space, const Grid& grid, Seen seen, std::vector<UnnamedFamily>& families) {
  const TrackSet& set = space.set();
  std::vector<ScoreColumn> columns;
  for (int b = 0; b < grid.bumps; ++b) {
    std::vector<Eigen::VectorXd> changes;
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      const auto& place = seen == Seen::over_x ? space.modelled(i) : set.motions[i].t_s;
      const auto& v = space.fit().motions[i].v_m_s;
      Eigen::VectorXd change(static_cast<Eigen::Index>(place.size()));
      for (std::size_t p = 0; p < place.size(); ++p) {
        change[static_cast<Eigen::Index>(p)] =
            (seen == Seen::late ? v[p] : 1.0) * bump(place[p], grid.at(b), grid.width());
      }
      changes.push_back(std::move(change));
    }
    columns.push_back(space.project(changes));
  }
  add_shapes(space, columns, grid,
             family_of(seen == Seen::over_x ? GapVariable::position : GapVariable::time,
                       seen == Seen::late ? GapKind::lateness : GapKind::displacement, seen == Seen::late ? "s" : "m"),
             families);
}

/// Waves over the positions of each motion.
std::vector<TurningWaves> swings_of(const ScoreSpace& space, double f_1_m, double step_1_m) {
  std::vector<TurningWaves> waves;
  for (std::size_t i = 0; i < space.set().motions.size(); ++i) {
    waves.emplace_back(space.modelled(i), f_1_m, step_1_m);
  }
  return waves;
}

/// sin and cos of 2 pi f x as changes of all positions.
std::vector<ScoreColumn> swing_columns(const ScoreSpace& space, const std::vector<TurningWaves>& waves) {
  std::vector<Eigen::VectorXd> sines, cosines;
  for (const TurningWaves& of_motion : waves) {
    sines.emplace_back(of_motion.sin());
    cosines.emplace_back(of_motion.cos());
  }
  return {space.project(sines), space.project(cosines)};
}

/// Of many periods, only those in the middle are drawn: all of them would get too few points to show their shape.
void draw_swing(const Grid& x, double f_1_m, const SpreadEvidence& evidence, UnnamedFamily& family) {
  family.at.clear();
  family.size.clear();
  family.sd.clear();
  constexpr int kDrawn = 240;
  constexpr double kDrawnPeriods = 12.0;
  const double range = x.high - x.low, drawn = std::min(range, kDrawnPeriods / f_1_m);
  for (int j = 0; j <= kDrawn; ++j) {
    const double place = x.low + 0.5 * (range - drawn) + drawn * j / kDrawn,
                 turn = 2.0 * std::numbers::pi * f_1_m * place;
    const Eigen::Vector2d basis(std::sin(turn), std::cos(turn));
    family.at.push_back(place);
    family.size.push_back(basis.dot(evidence.mean));
    family.sd.push_back(std::sqrt(std::max(0.0, basis.dot(evidence.covariance * basis))));
  }
}

/// A wave acts everywhere, and not only where it is drawn.
void name_everywhere(const Grid& x, UnnamedFamily& family) {
  name_regions(family);
  if (family.regions.empty()) return;
  UnnamedRegion largest = *std::max_element(family.regions.begin(), family.regions.end(),
                                            [](const auto& a, const auto& b) { return a.excess < b.excess; });
  largest.from = x.low;
  largest.to = x.high;
  family.regions = {largest};
}

/// The gain of waves of many periods from the sums of r sin and r cos alone: the fitted parameters absorb nothing of
/// them. It is computed at f, f + step, and so on, by rotating each point's sine and cosine.
class FineSwings {
 public:
  FineSwings(const ScoreSpace& space, double f_1_m, double step_1_m) {
    const Eigen::VectorXd& rest = space.residual().rest;
    for (std::size_t i = 0; i < space.set().motions.size(); ++i) {
      const TrackedMotion& motion = space.set().motions[i];
      for (std::size_t p = 0; p < motion.x_m.size(); ++p) {
        if (motion.outlier[p] != 0) continue;
        const double turn = 2.0 * std::numbers::pi * space.modelled(i)[p], weight = 1.0 / motion.sd_of(p);
        waves_.push_back({weight * rest[space.offset(i) + static_cast<Eigen::Index>(p)], std::sin(turn * f_1_m),
                          std::cos(turn * f_1_m), std::sin(turn * step_1_m), std::cos(turn * step_1_m)});
        squares_ += 0.5 * weight * weight;
      }
    }
    nothing_ = log_spread_evidence(squares_ * Eigen::Matrix2d::Identity(), Eigen::Vector2d::Zero()).log_evidence;
  }

  /// At the present f; then advances to the next.
  SpreadEvidence next() {
    Eigen::Vector2d sums = Eigen::Vector2d::Zero();
    for (Wave& w : waves_) {
      sums += w.residual * Eigen::Vector2d(w.sin, w.cos);
      const double sin = w.sin * w.step_cos + w.cos * w.step_sin;
      w.cos = w.cos * w.step_cos - w.sin * w.step_sin;
      w.sin = sin;
    }
    SpreadEvidence evidence;
    evidence.free_gain = 0.5 * sums.squaredNorm() / squares_;
    evidence.log_evidence = nothing_;
    if (evidence.free_gain < kLeastCoarseGain) return evidence;
    return log_spread_evidence(squares_ * Eigen::Matrix2d::Identity(), sums);
  }

 private:
  struct Wave {
    double residual, sin, cos, step_sin, step_cos;
  };
  std::vector<Wave> waves_;
  double squares_ = 0.0, nothing_ = 0.0;
};

/// Whether rounding causes such a wave: its error has the period of the step and fractions of it. It is in the noise.
bool swings_by_rounding(const TrackSet& set, double f_1_m, double range_m) {
  constexpr double kResolution = 2.0;  // in units of 1/range: two frequencies closer than that cannot be told apart
  return std::any_of(set.motions.begin(), set.motions.end(), [&](const TrackedMotion& motion) {
    if (!(motion.step_m > 0.0)) return false;
    const double order = std::max(1.0, std::round(f_1_m * motion.step_m));
    return std::abs(f_1_m - order / motion.step_m) < kResolution / range_m;
  });
}

/// A displacement that is periodic in position: sin and cos of 2 pi f x, with one f for all motions, averaged over.
UnnamedFamily swing_family(const ScoreSpace& space, const Grid& x) {
  const TrackSet& set = space.set();
  UnnamedFamily family = family_of(GapVariable::position, GapKind::displacement, "m");
  std::vector<double> steps;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const auto& at = space.modelled(i);
    for (std::size_t p = 1; p < at.size(); ++p) steps.push_back(std::abs(at[p] - at[p - 1]));
  }
  const double range = x.high - x.low;
  if (steps.empty() || !(range > 0.0)) return family;
  // Half of all frames lie closer together than this: at least two of them to a period. No more trials than
  // kMostSwings.
  const double step = 0.3 / range;
  const double highest = std::min(0.5 / std::max(core::median_of(std::move(steps)), 1e-9), kMostSwings * step);
  std::vector<double> logs;
  const auto try_swing = [&](double f, const std::vector<TurningWaves>& waves) {
    SpreadEvidence evidence;
    const Tried tried = try_one(space, swing_columns(space, waves), family, evidence);
    if (tried.better) draw_swing(x, f, evidence, family);
    return tried.log_evidence;
  };
  double f = kFewestSwings / range;
  for (std::vector<TurningWaves> waves = swings_of(space, f, step); f < highest; f += step) {
    if (!swings_by_rounding(set, f, range)) logs.push_back(try_swing(f, waves));
    for (TurningWaves& of_motion : waves) of_motion.turn();
  }
  // Finer waves pass by more than one period from frame to frame, each motion in steps of its own. They still show as a
  // function of position: an example is the pixels, if a marker crosses several of them from frame to frame. For films
  // the pixels' errors are in the fit.
  if (!set.images) {
    FineSwings fine(space, f, step);
    double most = kLeastFineGain, best_f = 0.0;
    std::size_t best = 0;
    for (; f < kFinestSwings / range; f += step) {
      const SpreadEvidence evidence = fine.next();
      if (swings_by_rounding(set, f, range)) continue;
      logs.push_back(evidence.log_evidence);
      if (evidence.free_gain <= most) continue;
      most = evidence.free_gain;
      best_f = f;
      best = logs.size() - 1;
    }
    if (best_f > 0.0) logs[best] = try_swing(best_f, swings_of(space, best_f, 0.0));
  }
  if (!logs.empty()) family.log_evidence = base::log_mean(logs);
  name_everywhere(x, family);
  return family;
}

/// An acceleration that is periodic in position, as a row of magnets or the teeth of a rack cause it.
UnnamedFamily pull_family(const ScoreSpace& space, const Grid& x) {
  const TrackSet& set = space.set();
  UnnamedFamily family = family_of(GapVariable::position, GapKind::acceleration, "m/s²");
  const double range = x.high - x.low;
  if (!(range > 0.0)) return family;
  std::vector<double> logs;
  for (double periods = kFewestSwings; periods <= kMostPulls; periods += 0.5) {
    std::vector<ScoreColumn> columns;
    for (const double phase : {0.0, 0.25}) {
      std::vector<UnnamedForce> forces;
      for (const TrackedMotion& motion : set.motions) {
        const double mass_kg = set.masses[motion.mass].mass_kg;
        forces.push_back([=](double at, double, double) {
          return mass_kg * std::sin(2.0 * std::numbers::pi * (periods / range * at + phase));
        });
      }
      columns.push_back(space.of_force(forces, 1e-4));
    }
    SpreadEvidence evidence;
    const Tried tried = try_one(space, columns, family, evidence);
    if (tried.better) draw_swing(x, periods / range, evidence, family);
    logs.push_back(tried.log_evidence);
  }
  family.log_evidence = base::log_mean(logs);
  name_everywhere(x, family);
  return family;
}

}  // namespace

void add_place_families(const ScoreSpace& space, std::vector<FamilySearch>& searches) {
  const Ranges ranges = ranges_of(space);
  const bool more_masses = space.set().masses.size() > 1;
  const auto force = [&](const Grid& grid, Place over, GapVariable variable, Force kind, Load load) {
    searches.emplace_back(
        [=, &space](auto& families) { add_force(space, grid, over, variable, kind, load, families); });
  };
  const auto displacement = [&](const Grid& grid, Seen seen) {
    searches.emplace_back([=, &space](auto& families) { add_displacement(space, grid, seen, families); });
  };
  for (const int bumps : {kSmooth, kCoarse, kFine}) {
    Grid v = ranges.v, x = ranges.x, t = ranges.t, speed = ranges.speed;
    v.bumps = x.bumps = t.bumps = speed.bumps = bumps;
    force(v, Place::v, GapVariable::speed, Force::drive, Load::none);
    force(speed, Place::v, GapVariable::speed, Force::friction, more_masses ? Load::either : Load::none);
    force(x, Place::x, GapVariable::position, Force::drive, more_masses ? Load::either : Load::mass);
    force(x, Place::x, GapVariable::position, Force::friction, Load::mass);
    displacement(x, Seen::over_x);
    displacement(t, Seen::over_t);
    displacement(t, Seen::late);
    if (bumps == kFine) continue;
    force(t, Place::t, GapVariable::time, Force::drive, more_masses ? Load::either : Load::mass);
    force(t, Place::t, GapVariable::time, Force::friction, Load::mass);
    force(x, Place::x, GapVariable::position, Force::drag, Load::none);
    force(t, Place::t, GapVariable::time, Force::drag, Load::none);
  }
  searches.emplace_back([=, &space](auto& families) { families.push_back(swing_family(space, ranges.x)); });
  searches.emplace_back([=, &space](auto& families) { families.push_back(pull_family(space, ranges.x)); });
}

}  // namespace glidelab::diagnose
