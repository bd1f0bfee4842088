#include "diagnose/recovered/recovered.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "base/math/distributions.h"
#include "core/experiment/clip_setup.h"
#include "core/result/estimate.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/recovered/clip_spread.h"
#include "diagnose/recovered/scale_place.h"
#include "diagnose/weigh/unknown_noise.h"

namespace glidelab::diagnose {
namespace {

// Standard deviations of what is not known (of a rate: unknown_rate()). Motion in one direction shows only
// mu - tan(alpha), so that the two are unknown together.
constexpr double kUnknownAngle_rad = 0.1, kUnknownMu = kUnknownAngle_rad, kUnknownRate = 1.0;
constexpr double kNoLoad = 0.02;         // cos(alpha) below which there is no normal force to speak of
constexpr double kInstant_s = 1e-4;      // time step over which an acceleration is taken
constexpr double kFastest_m_s = 1000.0;  // upper limit of a terminal velocity

/// The standard deviation from which K/m counts as not known: 1/s or, if larger, K/m itself.
double unknown_rate(double rate_1_s) {
  return std::max(kUnknownRate, kUnknownRate * std::abs(rate_1_s));
}

/// Leaves out effects that act only at some positions, times or clips: a terminal velocity is that of the
/// configuration.
void leave_out_passing(EffectValues& effects) {
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    const EffectLaw& law = effect_list()[e].law;
    for (std::size_t k = law.size; law.passing && k < law.size + law.sizes; ++k) effects[EffectSlot{e, k}] = 0.0;
  }
}

/// The acceleration at speed v > 0 in the middle of the set-up's positions.
double acceleration(TrackModel model, double v_m_s) {
  model.x0_m = model.x_mid_m;
  model.v0_m_s = v_m_s;
  model.known = nullptr;
  model.row_px = {};
  leave_out_passing(model.effects);
  const double times[] = {0.0, kInstant_s};
  return (move(model, times).v_m_s.back() - v_m_s) / kInstant_s;
}

/// The speed at which the force vanishes. Empty if the glider stops, or if it still accelerates at kFastest_m_s.
std::optional<double> terminal_velocity(const TrackModel& model) {
  double low = 1e-3, high = 1e-3;
  if (!(acceleration(model, low) > 0.0)) return {};
  while (high < kFastest_m_s && acceleration(model, high) > 0.0) {
    low = high;
    high *= 1.5;
  }
  if (high >= kFastest_m_s) return {};
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (acceleration(model, middle) > 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// One quantity of one configuration under one explanation.
struct Recovered {
  double value = 0.0, sd = 0.0, degrees = 0.0;
  bool known = false;
  core::AnyReason why = core::unknown::NotToldApart{};
};

struct RecoveredSet {
  std::pair<std::size_t, std::size_t> of;  ///< group and mass
  Recovered k_over_m_1_s, mu, alpha_rad, v_lim_m_s;
};

const EffectSlot kOwnFriction{effect_index(ids::clip_scatter), 0}, kOwnDrag{effect_index(ids::clip_scatter), 1};

/// The motions of each configuration, the first of each clip.
std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> motions_of_configurations(const TrackSet& set) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> configurations;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    std::vector<std::size_t>& of = configurations[{set.motions[i].group, set.motions[i].mass}];
    const bool is_new = std::none_of(of.begin(), of.end(),
                                     [&](std::size_t other) { return set.motions[other].clip == set.motions[i].clip; });
    if (is_new) of.push_back(i);
  }
  return configurations;
}

/// The model of a configuration, with the mean friction and drag of its clips where each has its own. The mean of their
/// deviations and the common friction or drag are known together alone.
TrackModel model_of_all(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at,
                        const std::vector<std::size_t>& motions) {
  TrackModel model = model_of(set, layout, at, motions.front());
  double more_mu = 0.0, more_drag = 0.0;
  for (const std::size_t i : motions) {
    const TrackModel one = model_of(set, layout, at, i);
    more_mu += one.effects[kOwnFriction] / static_cast<double>(motions.size());
    more_drag += one.effects[kOwnDrag] / static_cast<double>(motions.size());
  }
  model.mu += more_mu;
  model.k_n_s_m *= 1.0 + more_drag;
  model.effects[kOwnFriction] = model.effects[kOwnDrag] = 0.0;
  return model;
}

/// How far clips differ in one of their own parameters.
ClipSpread spread_in(const ParameterLayout& layout, const EffectSlot& slot, const Eigen::VectorXd& at,
                     const Eigen::MatrixXd& covariance) {
  std::vector<Eigen::Index> of;
  double prior_sd = 0.0;
  for (std::size_t g = 0; g < layout.globals().size(); ++g) {
    const ParameterLayout::Global& global = layout.globals()[g];
    if (global.parameter == nullptr || !(global.parameter->slot == slot)) continue;
    of.push_back(static_cast<Eigen::Index>(g));
    prior_sd = global.parameter->held_sd;
  }
  if (of.size() < 2) return {};
  return clip_spread(at(of), covariance(of, of), prior_sd);
}

/// Whether a common parameter stopped at the edge of its range.
bool is_at_limit(const MotionFit& fit, ParameterLayout::Global::Kind kind, std::size_t index) {
  return std::any_of(fit.statements.begin(), fit.statements.end(), [&](const FitStatement& s) {
    const ParameterLayout::Global& of = fit.layout->globals()[s.global];
    return s.held && of.kind == kind && of.index == index;
  });
}

/// Multiplies all lengths: the motions determine g sin(alpha), mu g cos(alpha) and v_lim as lengths over times.
void scale_lengths(RecoveredSet& of, const ScaleFactor& by) {
  const double fitted_rad = of.alpha_rad.value, fitted_cos = std::cos(fitted_rad);
  of.alpha_rad.value = std::asin(std::clamp(by.value * std::sin(fitted_rad), -1.0, 1.0));
  of.alpha_rad.sd = std::hypot(of.alpha_rad.sd, by.sd * std::tan(of.alpha_rad.value));
  of.mu.value *= by.value * fitted_cos / std::cos(of.alpha_rad.value);
  of.mu.sd = std::hypot(of.mu.sd, by.sd * of.mu.value);
  of.v_lim_m_s.value *= by.value;
  of.v_lim_m_s.sd = std::hypot(of.v_lim_m_s.sd, by.sd * of.v_lim_m_s.value);
  for (Recovered* const one : {&of.alpha_rad, &of.mu, &of.v_lim_m_s}) one->known &= std::isfinite(one->value);
}

/// A camera that drifts by d adds d to every speed: by as much the terminal velocity is wrong, and g sin(alpha) by
/// d |a'(v)|, for the drag at the true speed is that found at another.
void allow_for_drift(RecoveredSet& of, double drift_m_s, double slope_1_s, double gravity_m_s2) {
  const double of_alpha_rad = drift_m_s * std::abs(slope_1_s) / (gravity_m_s2 * std::cos(of.alpha_rad.value));
  of.v_lim_m_s.sd = std::hypot(of.v_lim_m_s.sd, drift_m_s);
  of.v_lim_m_s.known &= of.v_lim_m_s.sd < of.v_lim_m_s.value;
  of.alpha_rad.sd = std::hypot(of.alpha_rad.sd, of_alpha_rad);
  of.alpha_rad.known &= of.alpha_rad.sd < kUnknownAngle_rad;
}

std::vector<RecoveredSet> recovered_under(const TrackSet& set, const MotionFit& fit, const RemainderSizes& sizes) {
  RemainderSpace::Solution solution = RemainderSpace(set, fit).solve(sizes);
  FitPoint at = fit.at;
  at.global += solution.change;
  // The mean of clips that differ is that of the configuration to within their scatter over the root of their number.
  const auto& globals = fit.layout->globals();
  Eigen::VectorXd between_own = Eigen::VectorXd::Zero(at.global.size());
  MotionFit narrowed;
  for (const EffectSlot& slot : {kOwnFriction, kOwnDrag}) {
    const ClipSpread spread = spread_in(*fit.layout, slot, at.global, solution.covariance);
    if (!(spread.most > 0.0)) continue;
    if (narrowed.layout == nullptr) narrowed = fit;
    for (std::size_t g = 0; g < globals.size(); ++g) {
      const bool is_own = globals[g].parameter != nullptr && globals[g].parameter->slot == slot;
      if (is_own) between_own[static_cast<Eigen::Index>(g)] = spread.variance;
    }
    for (FitStatement& s : narrowed.statements) {
      const ParameterLayout::Global& of_statement = globals[s.global];
      const bool is_own = of_statement.parameter != nullptr && of_statement.parameter->slot == slot;
      if (is_own && !s.held) s.sd = std::sqrt(spread.most);
    }
  }
  // Clips that differ by little cannot stand for an inclination that is far off.
  const bool is_narrowed = narrowed.layout != nullptr;
  if (is_narrowed) {
    solution = RemainderSpace(set, narrowed).solve(sizes);
    at.global = fit.at.global + solution.change;
  }
  // The degrees of freedom of the scatter from motion to motion are the motions less one, those of the scores the clips
  // less one, those of the noise of few positions theirs.
  const bool scatters = sizes.force_m_s2 > 0.0 || sizes.drag > 0.0;
  const double of_motions =
      scatters ? std::max(1.0, static_cast<double>(set.motions.size()) - 1.0) : std::numeric_limits<double>::infinity();
  const std::optional<FewPositions> few = few_positions(set);
  const double of_noise = few ? few->degrees : std::numeric_limits<double>::infinity();
  const double of_clips = std::max(1.0, static_cast<double>(set.clips.size()) - 1.0);
  // The motions determine mu g and g sin(alpha); where gravity is no parameter of the fit, its uncertainty is added.
  const double by_gravity = gravity_matters(set) ? 0.0 : set.gravity_sd_m_s2 / set.gravity_m_s2;
  const auto root_of = [](const Eigen::MatrixXd& covariance, const Eigen::VectorXd& by) {
    const Eigen::VectorXd along = base::product(covariance, by);
    return std::sqrt(std::max(0.0, by.dot(along)));
  };
  std::vector<RecoveredSet> all;
  for (const auto& [of, motions] : motions_of_configurations(set)) {
    // The derivatives of a quantity with respect to the common parameters, by finite differences.
    const auto gradient = [&, &motions = motions](const auto& value) {
      Eigen::VectorXd by = Eigen::VectorXd::Zero(at.global.size());
      for (std::size_t g = 0; g < globals.size(); ++g) {
        if (std::none_of(motions.begin(), motions.end(), [&](auto i) { return touches(set, globals[g], i); })) continue;
        const auto k = static_cast<Eigen::Index>(g);
        const double step = std::max(1e-9, 0.01 * std::sqrt(std::max(0.0, solution.covariance(k, k))));
        FitPoint near = at;
        near.global[k] += step;
        const double above = value(near);
        near.global[k] -= 2.0 * step;
        by[k] = (above - value(near)) / (2.0 * step);
      }
      return by;
    };
    const auto found = [&](double value, const Eigen::VectorXd& by, double scale) {
      Recovered one;
      const double model = root_of(solution.covariance, by), between = root_of(solution.between_clips, by);
      const double own = std::sqrt(by.cwiseAbs2().dot(between_own));
      one.value = value;
      one.sd = std::hypot(std::max(model, between), own) * scale;
      one.degrees = std::min(is_narrowed || std::max(between, own) > model ? of_clips : of_motions, of_noise);
      one.known = std::isfinite(one.value) && std::isfinite(one.sd);
      return one;
    };
    const auto model_at = [&, &motions = motions](const FitPoint& point) {
      return model_of_all(set, *fit.layout, point, motions);
    };
    const auto rate = [&](const FitPoint& point) {
      const TrackModel model = model_at(point);
      return own_law(model).k_n_s_m / model.mass_kg;
    };
    const auto mu = [&](const FitPoint& point) { return own_law(model_at(point)).mu; };
    const auto alpha = [&](const FitPoint& point) { return model_at(point).alpha_rad; };
    RecoveredSet one;
    one.of = of;
    one.k_over_m_1_s = found(rate(at), gradient(rate), 1.0);
    one.k_over_m_1_s.known &= one.k_over_m_1_s.sd < unknown_rate(rate(at));
    if (holds_drag(set, fit.effects)) {
      one.k_over_m_1_s.known = false;
      one.k_over_m_1_s.why = core::unknown::DragNotViscous{};
    }
    one.mu = found(mu(at), gradient(mu), 1.0);
    one.mu.sd = std::hypot(one.mu.sd, by_gravity * one.mu.value);
    one.mu.known &= one.mu.sd < kUnknownMu;
    if (!(std::cos(alpha(at)) > kNoLoad) || is_fall(set.groups[of.first])) {
      one.mu.known = false;
      one.mu.why = core::unknown::FreeFall{};
    }
    one.alpha_rad = found(alpha(at), gradient(alpha), 1.0);
    one.alpha_rad.sd = std::hypot(one.alpha_rad.sd, by_gravity * std::tan(one.alpha_rad.value));
    one.alpha_rad.known &= one.alpha_rad.sd < kUnknownAngle_rad;
    if (is_at_limit(fit, ParameterLayout::Global::Kind::alpha, of.first)) {
      one.alpha_rad.known = false;
      one.alpha_rad.why = core::unknown::AtItsLimit{};
    }
    double slope = rate(at);
    if (const std::optional<double> v = terminal_velocity(model_at(at))) {
      // A small change da of the acceleration shifts v_lim by dv = -da/a'(v).
      const double apart = 1e-3 * *v;
      slope = (acceleration(model_at(at), *v + apart) - acceleration(model_at(at), *v - apart)) / (2.0 * apart);
      const auto there = [&](const FitPoint& point) { return acceleration(model_at(point), *v); };
      one.v_lim_m_s = found(*v, gradient(there), 1.0 / std::abs(slope));
      one.v_lim_m_s.known &= one.v_lim_m_s.sd < *v;
    } else {
      one.v_lim_m_s.why = core::unknown::NoBalance{};
    }
    if (set.plain_scale) scale_lengths(one, scale_along_path(model_at(at)));
    if (set.camera_drift_m_s > 0.0) allow_for_drift(one, set.camera_drift_m_s, slope, set.gravity_m_s2);
    all.push_back(one);
  }
  return all;
}

/// The distance from `centre` within which a quantity lies with 95 % by these explanations together.
double half_width95(double centre, const std::vector<std::pair<Recovered, double>>& of) {
  constexpr double kOutside = 0.05;
  const auto too_much_outside = [&](double distance) {
    double outside = 0.0, sum = 0.0;
    for (const auto& [one, probability] : of) {
      sum += probability;
      if (one.sd > 0.0) {
        outside += probability * (base::student_t_tail(one.degrees, (centre + distance - one.value) / one.sd) +
                                  base::student_t_tail(one.degrees, (one.value - centre + distance) / one.sd));
      } else if (!(std::abs(one.value - centre) <= distance)) {
        outside += probability;
      }
    }
    return outside - kOutside * sum;
  };
  double far = 0.0;  // at least 95 % of each lie within this distance
  for (const auto& [one, probability] : of) {
    far = std::max(far, std::abs(one.value - centre) + core::student_t975(one.degrees) * one.sd);
  }
  if (!(too_much_outside(far) < 0.0)) return far;
  std::uintmax_t most = 100;
  return boost::math::tools::toms748_solve(too_much_outside, 0.0, far, boost::math::tools::eps_tolerance<double>(30),
                                           most)
      .second;
}

/// A quantity under the reported explanation, with `others` as far as they are likely: the reported value, and the sd
/// whose 95 % interval is that of all of them together. An unlikely explanation far away widens it little.
core::Quantity mixed(const Recovered& own, double probability, const std::vector<std::pair<Recovered, double>>& others,
                     double unit, double unknown_sd) {
  if (!own.known) return core::undetermined(own.why);
  std::vector<std::pair<Recovered, double>> all{{own, probability}};
  for (const auto& [other, p] : others) {
    if (other.known) all.emplace_back(other, p);
  }
  const double sd = all.size() > 1 ? half_width95(own.value, all) / core::student_t975(own.degrees) : own.sd;
  if (!(sd < unknown_sd)) return core::undetermined(core::unknown::ExplanationsDiffer{});
  return core::determined(core::estimate(own.value / unit, sd / unit, own.degrees));
}

}  // namespace

std::vector<RecoveredConfiguration> recovered_of(const TrackSet& set, const Explanations& explanations) {
  const LikelyFit& reported = explanations.front();
  std::vector<std::vector<RecoveredSet>> under;
  for (const LikelyFit& one : explanations) under.push_back(recovered_under(set, *one.fit, one.sizes));
  const auto mixture = [&](std::size_t c, Recovered RecoveredSet::*quantity, double unit, double unknown_sd) {
    // Values from a fit on its way may be off by any number of their standard deviations.
    if (!reported.at_minimum) return core::undetermined(core::unknown::NoMinimum{});
    std::vector<std::pair<Recovered, double>> others;
    for (std::size_t h = 1; h < under.size(); ++h) {
      others.emplace_back(under[h][c].*quantity, explanations[h].probability);
    }
    return mixed(under.front()[c].*quantity, reported.probability, others, unit, unknown_sd);
  };
  std::vector<RecoveredConfiguration> recovered;
  for (std::size_t c = 0; c < under.front().size(); ++c) {
    const auto& [group, mass] = under.front()[c].of;
    RecoveredConfiguration one;
    one.group = set.groups[group].name;
    one.mass_kg = set.masses[mass].mass_kg;
    one.incline_deg = set.groups[group].stated_rad / base::kRadPerDegree;
    one.is_named_by_incline = one.group == core::group_of_incline(set.groups[group].stated_rad);
    for (const std::size_t e : reported.fit->effects) one.with.emplace_back(effect_list()[e].id);
    const RecoveredSet& own = under.front()[c];
    one.k_over_m_1_s = mixture(c, &RecoveredSet::k_over_m_1_s, 1.0, unknown_rate(own.k_over_m_1_s.value));
    one.mu = mixture(c, &RecoveredSet::mu, 1.0, kUnknownMu);
    one.alpha_deg = mixture(c, &RecoveredSet::alpha_rad, base::kRadPerDegree, kUnknownAngle_rad);
    one.v_lim_m_s = mixture(c, &RecoveredSet::v_lim_m_s, 1.0, own.v_lim_m_s.value);
    recovered.push_back(std::move(one));
  }
  return recovered;
}

}  // namespace glidelab::diagnose
