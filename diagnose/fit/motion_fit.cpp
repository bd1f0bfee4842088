#include "diagnose/fit/motion_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/math/dense.h"
#include "base/math/levenberg_marquardt.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/fit_step.h"
#include "diagnose/fit/integrated_start.h"

namespace glidelab::diagnose {
namespace {

constexpr int kMostIterations = 40;
constexpr double kRounding = 1e-10;        // of chi²: a sum of thousands of squares of differences of positions
constexpr double kConvergedChange = 1e-3;  // change of chi², small compared with the changes that evidence rests on
// A combination of parameters that the data hardly determine (a frame rate beside K, mu and the inclination) lies along
// a curved valley with steep walls. A step along it ends far up a wall, from where undamped steps lead back down. The
// step has failed if this many of them do not.
constexpr int kMostStepsBack = 4;
constexpr int kMostVainReturns = 2;                             // after that many failures there is no valley
constexpr double kSteepest_rad = 1.5, kBeyondStated_rad = 0.2;  // steepest inclination; or this far beyond the stated
                                                                // one
constexpr double kSmallSteps = 1.0;  // initial damping: half the Newton step in directions that are well separated
using Global = ParameterLayout::Global;

bool inside(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at) {
  for (std::size_t i = 0; i < at.own.size(); ++i) {
    if (!(std::abs(at.own[i][kStartSpeed]) <= fastest_start(set.motions[i]))) return false;
  }
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const Global& global = layout.globals()[g];
    const double value = at.global[static_cast<Eigen::Index>(g)];
    if (!std::isfinite(value)) return false;
    if (global.kind == Global::Kind::alpha) {
      const double stated = std::abs(set.groups[global.index].stated_rad);
      if (std::abs(value) > std::max(kSteepest_rad, stated + kBeyondStated_rad)) return false;
    }
    if (!has_range(global)) continue;
    if (value < global.range.low || value > global.range.high) return false;
  }
  return true;
}

std::vector<FitStatement> statements_of(const TrackSet& set, const ParameterLayout& layout) {
  std::vector<FitStatement> statements;
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const Global& global = layout.globals()[g];
    switch (global.kind) {
      case Global::Kind::k:
        if (holds_drag(set, layout.effects())) statements.push_back({g, 0.0, kStokesDrag_n_s_m, {}, false});
        break;
      case Global::Kind::alpha:
        for (const InclineStatement& s : set.groups[global.index].statements) {
          statements.push_back({g, s.alpha_rad, s.sd_rad, s.against, true});
        }
        statements.push_back({g,
                              set.groups[global.index].stated_rad,
                              is_fall(set.groups[global.index]) ? kFallInclination_rad : kOpenInclination_rad,
                              {},
                              false});
        break;
      case Global::Kind::mu:
        if (only_falls(set)) statements.push_back({g, 0.0, kFallFriction, {}, false});
        break;
      case Global::Kind::gravity:
      case Global::Kind::mass:
      case Global::Kind::mode:
      case Global::Kind::scale:
        statements.push_back({g, 0.0, 1.0, {}, true});
        break;
      case Global::Kind::effect:
        if (global.parameter->held_sd > 0.0) statements.push_back({g, 0.0, global.parameter->held_sd, {}, false});
        break;
      default:
        break;
    }
  }
  return statements;
}

double cost_of(const MotionFit& fit) {
  double cost = 0.0;
  for (const FitMotion& motion : fit.motions) cost += motion.residual.squaredNorm();
  for (const FitStatement& s : fit.statements) cost += s.chi2(fit.at.global[static_cast<Eigen::Index>(s.global)]);
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

void linearise_all(const TrackSet& set, MotionFit& fit, Derivatives derivatives) {
  fit.motions.clear();
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    fit.motions.push_back(linearise(set, *fit.layout, fit.at, i, fit.late, derivatives));
  }
}

/// Adds the derivatives at the point where the residuals are.
void derive_all(const TrackSet& set, MotionFit& fit, Derivatives derivatives) {
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    add_derivatives(set, *fit.layout, fit.at, i, fit.late, derivatives, fit.motions[i]);
  }
}

/// The fit at another point in parameter space: residuals and cost, no derivatives; the cost is infinite if a parameter
/// is not allowed there.
MotionFit moved_to(const TrackSet& set, const MotionFit& fit, FitPoint at) {
  MotionFit next;
  next.effects = fit.effects;
  next.layout = fit.layout;
  next.statements = fit.statements;
  next.late = fit.late;
  next.converged = fit.converged;
  next.iterations = fit.iterations;
  next.at = std::move(at);
  next.cost = std::numeric_limits<double>::infinity();
  if (!inside(set, *fit.layout, next.at)) return next;
  linearise_all(set, next, Derivatives::none);
  next.cost = cost_of(next);
  return next;
}

/// After a failed step, the next few are damped as much as the last success, so that not every other step is wasted.
base::FitOptions descent_options() {
  base::FitOptions options;
  options.most_iterations = kMostIterations;
  options.damping_start = 1e-6;
  options.damping_most = 1e6;
  options.floor_after_refusal = 3.0;
  options.floor_decay = 0.3;
  options.cost_absolute = kConvergedChange;
  options.cost_relative = 1e-3 * kConvergedChange;  // the same change again if the misfit is of the order of the number
                                                    // of points
  options.damping_settled = 1e-2;
  return options;
}

/// Holds a parameter of an effect where it starts: by a ten-millionth of its range.
FitStatement held_at(std::size_t global, double value, const ParameterRange& range) {
  return {global, value, 1e-7 * (range.high - range.low), {}, false};
}

/// A K, a gravity or an inclination that stopped at an edge stays there in whatever is linear about the fit.
void hold_at_edges(MotionFit& fit) {
  constexpr double kHeld = 1e-4;  // of the prior's standard deviation
  for (FitStatement& s : fit.statements) {
    const Global& global = fit.layout->globals()[s.global];
    if (global.kind == Global::Kind::effect || !has_range(global) || s.against) continue;
    const double at = fit.at.global[static_cast<Eigen::Index>(s.global)];
    if (at > global.range.low && at < global.range.high) continue;
    s.held = s.prior();
    s.value = at;
    s.sd *= kHeld;
  }
}

/// A fit at its minimum, not yet finished.
MotionFit descended(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                    const Lateness& late, const base::FitOptions& options, const std::vector<std::size_t>& held = {}) {
  MotionFit fit;
  fit.effects = effects;
  ParameterLayout layout(set, effects);
  layout.widen_to(start.global);
  fit.layout = std::make_shared<const ParameterLayout>(std::move(layout));
  fit.at = start;
  keep_within(set, *fit.layout, fit.at);  // K may come from a fit in which it was free
  fit.late = late;
  fit.statements = statements_of(set, *fit.layout);
  for (const std::size_t g : held) {
    fit.statements.push_back(held_at(g, fit.at.global[static_cast<Eigen::Index>(g)], fit.layout->globals()[g].range));
  }
  linearise_all(set, fit, Derivatives::none);
  fit.cost = cost_of(fit);
  struct Point {
    MotionFit fit;
    bool has_derivatives = false;
  };
  int vain_returns = 0;
  const auto try_step = [&](Point& here, double damping) {
    if (!here.has_derivatives) derive_all(set, here.fit, Derivatives::forward);
    here.has_derivatives = true;
    const double cost = here.fit.cost;
    MotionFit next = moved_to(set, here.fit, step_from(set, here.fit, damping));
    // At the minimum a step changes the cost by rounding alone, of either sign: that is no refusal.
    if (next.cost > cost && next.cost - cost <= kRounding * cost) next.cost = cost;
    if (!(next.cost <= cost) && vain_returns < kMostVainReturns) {
      for (int back = 0; back < kMostStepsBack && std::isfinite(next.cost) && !(next.cost <= cost); ++back) {
        derive_all(set, next, Derivatives::forward);
        next = moved_to(set, next, step_from(set, next, 0.0));
      }
      vain_returns += next.cost <= cost ? -1 : 1;
    }
    base::FitTrial<Point> trial;
    trial.cost = next.cost;
    trial.point = Point{std::move(next)};
    return trial;
  };
  Point here{std::move(fit)};
  const double start_cost = here.fit.cost;
  const base::FitSummary summary = base::levenberg_marquardt(here, start_cost, options, try_step);
  here.fit.iterations = summary.iterations;
  // If no step descends, only rounding is left, or the fit is at the edge of what is allowed.
  here.fit.converged = base::is_settled(summary.stop) || summary.stop == base::FitStop::no_descent;
  return std::move(here.fit);
}

/// The fit at its minimum with all that rests on it.
MotionFit finished(const TrackSet& set, MotionFit fit) {
  hold_at_edges(fit);
  derive_all(set, fit, Derivatives::central);
  return fit;
}

/// The parameters of a fit, with one more effect that is absent; its other parameters are taken from `like`, which has
/// the effect.
FitPoint with_absent(const TrackSet& set, const MotionFit& base, std::size_t effect, const MotionFit& like) {
  FitPoint point = with_effect(set, base, effect, {}, {});
  std::vector<std::size_t> effects = base.effects;
  effects.push_back(effect);
  const ParameterLayout layout(set, effects);
  const EffectInfo& info = effect_list()[effect];
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const Global& global = layout.globals()[g];
    // If an effect has many sizes, each of its parameters is one of them.
    const bool is_size = global.parameter == &info.parameters[info.law.size] || info.search == Search::spread;
    if (global.kind != Global::Kind::effect || global.effect != effect || is_size) continue;
    for (std::size_t k = 0; k < like.layout->globals().size(); ++k) {
      const Global& other = like.layout->globals()[k];
      if (!ParameterLayout::same(other, global)) continue;
      point.global[static_cast<Eigen::Index>(g)] = like.at.global[static_cast<Eigen::Index>(k)];
    }
  }
  return point;
}

/// The coefficient c of a quadratic drag that takes as much energy from the motions as K does in a fit; `least` if K is
/// not positive.
double drag_of_air_like(const MotionFit& fit, double least) {
  double squares = 0.0, cubes = 0.0;  // of the speed: the power is K v², or c v³
  for (const FitMotion& motion : fit.motions) {
    for (const double v : motion.v_m_s) {
      squares += v * v;
      cubes += std::abs(v) * v * v;
    }
  }
  const double like = fit.at.global[0] * squares / cubes;
  return like > least ? like : least;
}

}  // namespace

bool is_misfit(const TrackSet& set, const MotionFit& fit) {
  constexpr double kMostChi2PerPosition = 1.5;
  return fit.cost / static_cast<double>(points_of(set)) > kMostChi2PerPosition;
}

double chi2_of_stated(const MotionFit& fit) {
  double chi2 = 0.0;
  for (const FitStatement& one : fit.statements) {
    if (one.against) chi2 += one.chi2(fit.at.global[static_cast<Eigen::Index>(one.global)]);
  }
  return chi2;
}

double gain_in_stated(const MotionFit& base, const MotionFit& fit) {
  return std::isfinite(fit.cost) ? chi2_of_stated(base) - chi2_of_stated(fit) : 0.0;
}

MotionFit fit_motions(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                      const Lateness& late) {
  return finished(set, descended(set, effects, start, late, descent_options()));
}

MotionFit fit_held(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                   const Lateness& late, const std::vector<std::size_t>& held) {
  return finished(set, descended(set, effects, start, late, descent_options(), held));
}

namespace {

/// If a fit with one more effect is worse than the fit without: what a descent by small steps from there finds, unless
/// that is worse still. Not yet finished.
std::optional<MotionFit> by_small_steps(const TrackSet& set, const MotionFit& base, std::size_t effect,
                                        const MotionFit& fit) {
  if (fit.cost <= base.cost) return {};
  std::vector<std::size_t> effects = base.effects;
  effects.push_back(effect);
  base::FitOptions small_steps = descent_options();
  small_steps.damping_start = kSmallSteps;
  MotionFit again = descended(set, effects, with_absent(set, base, effect, fit), base.late, small_steps);
  if (!(again.cost <= fit.cost)) return {};
  return again;
}

}  // namespace

MotionFit no_worse_than(const TrackSet& set, const MotionFit& base, std::size_t effect, MotionFit fit) {
  std::optional<MotionFit> again = by_small_steps(set, base, effect, fit);
  return again ? finished(set, std::move(*again)) : fit;
}

MotionFit fit_with_effect(const TrackSet& set, const MotionFit& base, std::size_t effect, const FitPoint& start) {
  std::vector<std::size_t> effects = base.effects;
  effects.push_back(effect);
  MotionFit best = descended(set, effects, start, base.late, descent_options());
  // A quadratic drag in place of K is another model than `base`, and need not fit better.
  if (takes_place_of_drag(set, base.effects, effect)) return finished(set, std::move(best));
  // A size from a linear estimate far from the minimum may be wrong by decades.
  const auto size = base.at.global.size();
  const bool has_size = effect_list()[effect].law.size == 0 &&
                        effect_list()[effect].parameters[0].each == Each::experiment &&
                        effect_list()[effect].search != Search::spread;
  for (const double part : {0.1, 0.01, 10.0}) {
    if (!has_size || best.cost <= base.cost) break;
    FitPoint other = start;
    other.global[size] *= part;
    if (!inside(set, ParameterLayout(set, effects), other)) continue;
    MotionFit fit = descended(set, effects, other, base.late, descent_options());
    if (fit.cost < best.cost || !std::isfinite(best.cost)) best = std::move(fit);
  }
  if (std::optional<MotionFit> again = by_small_steps(set, base, effect, best)) best = std::move(*again);
  if (base.effects.empty() && (is_misfit(set, best) || !std::isfinite(best.cost))) {
    if (const std::optional<FitPoint> integrated = integrated_start(set, effect)) {
      MotionFit fit = descended(set, effects, *integrated, base.late, descent_options());
      if (fit.cost < best.cost || !std::isfinite(best.cost)) best = std::move(fit);
    }
  }
  return finished(set, std::move(best));
}

MotionFit linearise_at(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& at) {
  MotionFit fit;
  fit.effects = effects;
  fit.layout = std::make_shared<const ParameterLayout>(set, effects);
  fit.at = at;
  fit.statements = statements_of(set, *fit.layout);
  linearise_all(set, fit, Derivatives::central);
  fit.cost = cost_of(fit);
  return fit;
}

MotionFit linearise_again(const TrackSet& set, const MotionFit& fit) {
  MotionFit again = fit;
  linearise_all(set, again, Derivatives::central);
  again.cost = cost_of(again);
  return again;
}

FitPoint with_effect(const TrackSet& set, const MotionFit& fit, std::size_t effect, const std::vector<double>& values,
                     const std::vector<std::vector<double>>& own) {
  std::vector<std::size_t> effects = fit.effects;
  effects.push_back(effect);
  const ParameterLayout layout(set, effects);
  FitPoint point;
  point.global = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(layout.globals().size()));
  point.global.head(fit.at.global.size()) = fit.at.global;  // effects come last, and the new one is the last of them
  for (std::size_t v = 0; v < values.size(); ++v) {
    point.global[fit.at.global.size() + static_cast<Eigen::Index>(v)] = values[v];
  }
  if (!values.empty() && takes_place_of_drag(set, fit.effects, effect)) {
    point.global[fit.at.global.size()] = drag_of_air_like(fit, values.front());
    point.global[0] = 0.0;
  }
  for (std::size_t i = 0; i < fit.at.own.size(); ++i) {
    Eigen::VectorXd extended = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 + layout.own().size()));
    extended.head(fit.at.own[i].size()) = fit.at.own[i];
    for (std::size_t o = 0; !own.empty() && o < own[i].size(); ++o) {
      extended[fit.at.own[i].size() + static_cast<Eigen::Index>(o)] = own[i][o];
    }
    point.own.push_back(extended);
  }
  return point;
}

FitPoint with_some_effects(const ParameterLayout& layout, const MotionFit& from) {
  FitPoint start;
  start.global = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(layout.globals().size()));
  const auto& of = from.layout->globals();
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const auto& global = layout.globals()[g];
    for (std::size_t k = 0; k < of.size(); ++k) {
      if (ParameterLayout::same(of[k], global)) {
        start.global[static_cast<Eigen::Index>(g)] = from.at.global[static_cast<Eigen::Index>(k)];
      }
    }
  }
  for (const Eigen::VectorXd& own : from.at.own) {
    Eigen::VectorXd kept = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(2 + layout.own().size()));
    kept.head(2) = own.head(2);
    for (std::size_t o = 0; o < layout.own().size(); ++o) {
      for (std::size_t k = 0; k < from.layout->own().size(); ++k) {
        if (from.layout->own()[k] == layout.own()[o]) {
          kept[static_cast<Eigen::Index>(2 + o)] = own[static_cast<Eigen::Index>(2 + k)];
        }
      }
    }
    start.own.push_back(kept);
  }
  return start;
}

}  // namespace glidelab::diagnose
