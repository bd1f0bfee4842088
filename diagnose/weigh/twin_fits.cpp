#include "diagnose/weigh/twin_fits.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/long_work.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kMostTwins = 4;  // fits
constexpr double kMuchWorse = 20.0;    // of chi²
constexpr double kNoWorse = 2.0;       // of chi²: a fit that is worse than its twin by less is as good

/// The index of one of an effect's parameters among the common ones of a layout.
std::optional<Eigen::Index> global_of(const ParameterLayout& layout, EffectSlot slot) {
  const auto& globals = layout.globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].parameter != nullptr && globals[g].parameter->slot == slot) return static_cast<Eigen::Index>(g);
  }
  return {};
}

/// The index of a wave's phase in each motion's own parameters.
std::optional<Eigen::Index> phase_of(const ParameterLayout& layout, std::size_t effect) {
  const auto& own = layout.own();
  for (std::size_t o = 0; o < own.size(); ++o) {
    if (own[o]->slot.effect == effect) return static_cast<Eigen::Index>(2 + o);
  }
  return {};
}

/// The start for `to`, the mirror of `from`, in its place in a fit. Empty if a bumper is at the other end, or if the
/// size is beyond its range.
std::optional<FitPoint> start_of(const TrackSet& set, const MotionFit& fit, std::size_t from, std::size_t to,
                                 const ParameterLayout& layout) {
  FitPoint start = with_some_effects(layout, fit);
  const Mirror& mirror = effect_list()[from].mirror;
  const auto size = global_of(*fit.layout, {from, 0}), size_to = global_of(layout, {to, 0});
  const auto shape = global_of(*fit.layout, {from, 1}), shape_to = global_of(layout, {to, 1});
  if (!size || !size_to || !shape || !shape_to) return {};
  const double of_shape = fit.at.global[*shape], of_size = fit.at.global[*size];
  const double value = mirror.size != nullptr ? mirror.size(of_size, of_shape) : of_size;
  if (mirror.beyond_middle && !(of_shape > set.x_mid_m)) return {};
  if (effect_list()[from].search == Search::wave) {
    const auto phase = phase_of(*fit.layout, from), phase_to = phase_of(layout, to);
    if (!phase || !phase_to) return {};
    for (std::size_t i = 0; i < start.own.size(); ++i) {
      start.own[i][*phase_to] = fit.at.own[i][*phase] + mirror.phase_rad;
    }
  }
  const ParameterRange& range = layout.globals()[static_cast<std::size_t>(*size_to)].range;
  if (!(value < range.high)) return {};
  start.global[*size_to] = value;
  start.global[*shape_to] = of_shape;
  return start;
}

/// Two effects whose fits are as good, such as a bumper and a cable, are one cause for these data.
void join_names(std::size_t effect, std::size_t mirror, Comparison& comparison) {
  const Hypothesis *one = find(comparison, {effect}), *other = find(comparison, {mirror});
  if (comparison.alike.empty() || one == nullptr || other == nullptr || one->fit <= 0 || other->fit <= 0) return;
  const auto cost = [&](const Hypothesis& of) { return comparison.fits[static_cast<std::size_t>(of.fit)].cost; };
  if (!(std::abs(cost(*one) - cost(*other)) < kNoWorse)) return;
  const std::size_t first = std::min(comparison.alike[effect], comparison.alike[mirror]),
                    last = std::max(comparison.alike[effect], comparison.alike[mirror]);
  std::replace(comparison.alike.begin(), comparison.alike.end(), last, first);
}

/// The same of all pairs in which both move the body: images tell a camera from it.
void join_all_names(Comparison& comparison) {
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    const EffectInfo& info = effect_list()[e];
    if (info.mirror.id.empty()) continue;
    const std::size_t mirror = effect_index(info.mirror.id);
    if (e < mirror && !info.of_camera && !effect_list()[mirror].of_camera) join_names(e, mirror, comparison);
  }
}

struct TriedTwin {
  Hypothesis of;
  std::size_t from = 0, to = 0;
};

}  // namespace

void add_twins(const TrackSet& set, const std::set<std::size_t>& left_out, const Work& work, Comparison& comparison) {
  std::vector<Hypothesis> likeliest;
  for (const Hypothesis& one : comparison.all) {
    if (one.fit > 0 && !one.unnamed) likeliest.push_back(one);
  }
  std::sort(likeliest.begin(), likeliest.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  std::vector<TriedTwin> tried;
  for (const Hypothesis& one : likeliest) {
    for (const std::size_t e : one.effects) {
      const Mirror& mirror = effect_list()[e].mirror;
      if (mirror.id.empty() || (tried.size() >= kMostTwins && one.effects.size() > 1)) continue;
      const std::size_t to = effect_index(mirror.id);
      if (left_out.contains(to) || has(one, to)) continue;
      const MotionFit& fit = comparison.fits[static_cast<std::size_t>(one.fit)];
      if (std::find(fit.effects.begin(), fit.effects.end(), e) == fit.effects.end()) continue;
      std::set<std::size_t> effects(one.effects.begin(), one.effects.end());
      effects.erase(e);
      effects.insert(to);
      const Hypothesis* known = find(comparison, effects);
      const bool as_good = known != nullptr && known->fit > 0 &&
                           comparison.fits[static_cast<std::size_t>(known->fit)].cost < fit.cost + kNoWorse;
      if (!as_good) tried.push_back({one, e, to});
    }
  }
  std::vector<std::optional<Found>> found(tried.size());
  base::for_each_parallel(tried.size(), work.jobs, [&](std::size_t k) {
    work.look();
    const auto& [of, from, to] = tried[k];
    const MotionFit& fit = comparison.fits[static_cast<std::size_t>(of.fit)];
    std::vector<std::size_t> effects = fit.effects;
    std::replace(effects.begin(), effects.end(), from, to);
    const std::optional<FitPoint> start = start_of(set, fit, from, to, ParameterLayout(set, effects));
    if (!start) return;
    Found twin{of, fit_motions(set, effects, *start, fit.late)};
    if (!(twin.fit.cost < fit.cost + kMuchWorse)) return;  // it is no twin here
    std::replace(twin.hypothesis.effects.begin(), twin.hypothesis.effects.end(), from, to);
    const double gained = 0.5 * (fit.cost - twin.fit.cost);
    twin.hypothesis.gain += gained;
    twin.hypothesis.log_evidence += gained;
    found[k] = std::move(twin);
  });
  for (std::optional<Found>& one : found) {
    if (!one) continue;
    const std::vector<std::size_t>& effects = one->hypothesis.effects;
    std::erase_if(comparison.all, [&](const Hypothesis& other) {  // by its scan alone
      return !other.unnamed && other.fit < 0 && other.effects == effects;
    });
    add(comparison, std::move(*one));
  }
  join_all_names(comparison);
}

}  // namespace glidelab::diagnose
