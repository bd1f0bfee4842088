#include "diagnose/fit/parameter_layout.h"

#include <algorithm>
#include <utility>

namespace glidelab::diagnose {
namespace {

using Global = ParameterLayout::Global;

}  // namespace

bool touches(const TrackSet& set, const Global& global, std::size_t motion) {
  const TrackedMotion& of = set.motions[motion];
  if (global.kind == Global::Kind::alpha) return of.group == global.index;
  if (global.kind == Global::Kind::mass) return of.mass == global.index;
  if (global.kind == Global::Kind::mode) return global.index < of.shared_m.size() && !of.shared_m[global.index].empty();
  if (global.kind == Global::Kind::scale) return of.scale_sd > 0.0;
  return true;
}

ParameterLayout::ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects) : effects_(std::move(effects)) {
  using Kind = Global::Kind;
  globals_.push_back({Kind::k});
  globals_.push_back({Kind::mu});
  for (std::size_t g = 0; g < set.groups.size(); ++g) globals_.push_back({Kind::alpha, g});
  for (std::size_t m = 0; m < set.masses.size(); ++m) {
    if (set.masses[m].sd_kg > 0.0) globals_.push_back({Kind::mass, m});
  }
  for (std::size_t m = 0; m < set.modes; ++m) globals_.push_back({Kind::mode, m});
  const bool scale =
      std::any_of(set.motions.begin(), set.motions.end(), [](const auto& m) { return m.scale_sd > 0.0; });
  if (scale) globals_.push_back({Kind::scale});
  for (const std::size_t effect : effects_) {
    for (const EffectParameter& parameter : effect_list()[effect].parameters) {
      if (parameter.only_filmed && !set.pictures) continue;
      if (parameter.own) {
        own_.push_back(&parameter);
      } else {
        globals_.push_back({Kind::effect, 0, &parameter, effect, parameter.step, range_of(set, parameter)});
      }
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

TrackModel model_of(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const UnnamedForce* unnamed) {
  const TrackedMotion& data = set.motions[motion];
  TrackModel model;
  model.mass_kg = set.masses[data.mass].mass_kg;
  model.gravity_m_s2 = set.gravity_m_s2;
  model.x_mid_m = set.groups[data.group].x_mid_m;
  model.x_mid_all_m = set.x_mid_m;
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

}  // namespace glidelab::diagnose
