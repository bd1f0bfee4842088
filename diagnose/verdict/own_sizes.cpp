#include "diagnose/verdict/own_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "diagnose/effects/effect_library.h"
#include "diagnose/gap/size_uncertainty.h"

namespace glidelab::diagnose {
namespace {

constexpr Eigen::Index kDrag = 0, kMu = 1;  // indices of the common parameters
constexpr int kPlaces = 7;                  // positions at which a friction along the track is stated
constexpr int kDrawn = 141;                 // positions over which its mean square is taken

/// A value and its derivatives with respect to the common parameters.
struct Told {
  double value = 0.0;
  Eigen::VectorXd by;
};

class Teller {
 public:
  Teller(const TrackSet& set, const MotionFit& fit) : fit_(fit), uncertainty_(set, fit) {}

  Told at(Eigen::Index global) const {
    return {fit_.at.global[global], Eigen::VectorXd::Unit(fit_.at.global.size(), global)};
  }
  Told at(std::size_t global) const { return at(static_cast<Eigen::Index>(global)); }

  DiagnosedParameter as(const std::string& key, const Told& told) const {
    return {key, told.value, uncertainty_.sd(told.by)};
  }

 private:
  const MotionFit& fit_;
  SizeUncertainty uncertainty_;
};

Told sum(const Told& a, const Told& b) {
  return {a.value + b.value, a.by + b.by};
}

/// a (1 + sign b)
Told enlarged(const Told& a, const Told& b, double sign = 1.0) {
  const double factor = 1.0 + sign * b.value;
  return {a.value * factor, factor * a.by + sign * a.value * b.by};
}

/// The standard deviation of two or more values.
Told spread(const std::vector<Told>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, square = 0.0;
  for (const Told& one : values) mean += one.value / n;
  Told told{0.0, Eigen::VectorXd::Zero(values.front().by.size())};
  for (const Told& one : values) {
    square += (one.value - mean) * (one.value - mean) / (n - 1.0);
    told.by += (one.value - mean) / (n - 1.0) * one.by;
  }
  told.value = std::sqrt(square);
  if (told.value > 0.0) told.by /= told.value;
  return told;
}

std::string name_of(const TrackSet& set, const Configuration& configuration) {
  const std::string mass = fmt::format("{:.6g} kg", set.masses[configuration.mass].mass_kg);
  if (set.groups.size() == 1) return mass;
  const std::string group = own_name(set, configuration.group);
  return set.masses.size() == 1 ? group : group + ", " + mass;
}

/// mu + d or K (1 + d) of each configuration or clip. `sd_key` is the key of their standard deviation. `key` is that of
/// each value, followed by its name; if `key` is empty, the values are left out.
std::vector<DiagnosedParameter> own_values(const TrackSet& set, const MotionFit& fit, const EffectSlot& slot,
                                           Eigen::Index common, const std::string& sd_key, const std::string& key) {
  const std::vector<std::size_t> globals = fit.layout->all_of(slot);
  if (globals.size() < 2) return {};
  const Teller teller(set, fit);
  std::vector<Told> values;
  for (const std::size_t g : globals) {
    const Told deviation = teller.at(g), mean = teller.at(common);
    values.push_back(common == kMu ? sum(mean, deviation) : enlarged(mean, deviation));
  }
  std::vector<DiagnosedParameter> told = {teller.as(sd_key, spread(values))};
  for (std::size_t i = 0; i < globals.size() && !key.empty(); ++i) {
    const std::string name = name_of(set, fit.layout->globals()[globals[i]].configuration);
    told.push_back(teller.as(key + "." + name, values[i]));
  }
  return told;
}

/// s(x) of place_friction by its law: the ratio of the changed mu to mu, less 1.
std::vector<DiagnosedParameter> friction_along(const TrackSet& set, const MotionFit& fit, std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  const ParameterRange x = fit.layout->places();
  std::vector<std::size_t> globals;
  for (const EffectParameter& parameter : info.parameters) {
    const std::vector<std::size_t> one = fit.layout->all_of(parameter.slot);
    globals.insert(globals.end(), one.begin(), one.end());
  }
  const Teller teller(set, fit);
  const GliderConstants glider{.x_low_m = x.low, .x_high_m = x.high};
  // s is linear in its sizes, so the derivative with respect to a size is s for one unit of that size alone.
  const auto at = [&](double place) {
    Told told{0.0, Eigen::VectorXd::Zero(fit.at.global.size())};
    for (std::size_t j = 0; j < globals.size(); ++j) {
      std::vector<double> unit(info.parameters.size(), 0.0);
      unit[j] = 1.0;
      DryFriction of{.mu = 1.0};
      info.law.friction(unit.data(), glider, {place, 0.0, 0.0, 0.0, false}, of);
      told.by[static_cast<Eigen::Index>(globals[j])] = of.mu - 1.0;
    }
    told.value = told.by.dot(fit.at.global);
    return told;
  };
  const auto place = [&](int i, int of) { return x.low + (x.high - x.low) * (i + 0.5) / of; };
  Told all{0.0, Eigen::VectorXd::Zero(fit.at.global.size())};
  for (int i = 0; i < kDrawn; ++i) {
    const Told one = at(place(i, kDrawn));
    all.value += one.value * one.value / kDrawn;
    all.by += one.value / kDrawn * one.by;
  }
  all.value = std::sqrt(all.value);
  if (all.value > 0.0) all.by /= all.value;
  std::vector<DiagnosedParameter> told = {teller.as("sd", all)};
  for (int i = 0; i < kPlaces; ++i) {
    told.push_back(teller.as(fmt::format("s.at {:.3g} m", place(i, kPlaces)), at(place(i, kPlaces))));
  }
  return told;
}

}  // namespace

std::string own_name(const TrackSet& set, std::size_t group) {
  const auto named = [&](const TrackGroup& other) { return other.name == set.groups[group].name; };
  if (std::count_if(set.groups.begin(), set.groups.end(), named) == 1) return set.groups[group].name;
  return fmt::format("{} ({:.6g} deg)", set.groups[group].name,
                     set.groups[group].stated_rad * 180.0 / std::numbers::pi);
}

std::vector<DiagnosedParameter> own_sizes(const TrackSet& set, const MotionFit& fit, std::size_t effect) {
  const std::string_view id = effect_list()[effect].id;
  const std::vector<std::size_t> first = fit.layout->all_of({effect, 0});
  if (first.empty()) return {};
  if (id == ids::direction_dependent_drag) {
    const Teller teller(set, fit);
    const Told k = teller.at(kDrag), d = teller.at(first.front());
    return {teller.as("k_plus_n_s_m", enlarged(k, d)), teller.as("k_minus_n_s_m", enlarged(k, d, -1.0))};
  }
  if (id == ids::place_friction) return friction_along(set, fit, effect);
  if (id == ids::configuration_friction) return own_values(set, fit, {effect, 0}, kMu, "sd", "mu");
  if (id == ids::configuration_drag) return own_values(set, fit, {effect, 0}, kDrag, "sd_n_s_m", "k_n_s_m");
  if (id == ids::clip_scatter) {
    std::vector<DiagnosedParameter> told = own_values(set, fit, {effect, 0}, kMu, "sd_mu", "");
    for (DiagnosedParameter& drag : own_values(set, fit, {effect, 1}, kDrag, "sd_k_n_s_m", "")) {
      told.push_back(std::move(drag));
    }
    return told;
  }
  return {};
}

}  // namespace glidelab::diagnose
