#include "diagnose/verdict/own_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/gap/size_uncertainty.h"

namespace glidelab::diagnose {
namespace {

constexpr Eigen::Index kDrag = 0, kMu = 1;  // indices of the common parameters
constexpr EffectSlot kDragOfAir = slot_of(ids::quadratic_drag);
constexpr int kPlaces = 7;   // positions at which a friction along the track is stated
constexpr int kDrawn = 141;  // positions over which its mean square is taken

/// A value and its derivatives with respect to the common parameters.
struct Derived {
  double value = 0.0;
  Eigen::VectorXd by;
};

class FittedSizes {
 public:
  FittedSizes(const TrackSet& set, const MotionFit& fit) : fit_(fit), uncertainty_(set, fit) {}

  Derived at(Eigen::Index global) const {
    return {fit_.at.global[global], Eigen::VectorXd::Unit(fit_.at.global.size(), global)};
  }
  Derived at(std::size_t global) const { return at(static_cast<Eigen::Index>(global)); }

  DiagnosedParameter as(const std::string& key, const Derived& size) const {
    return {key, size.value, uncertainty_.sd(size.by)};
  }

 private:
  const MotionFit& fit_;
  SizeUncertainty uncertainty_;
};

Derived sum(const Derived& a, const Derived& b) {
  return {a.value + b.value, a.by + b.by};
}

/// a (1 + sign b)
Derived enlarged(const Derived& a, const Derived& b, double sign = 1.0) {
  const double factor = 1.0 + sign * b.value;
  return {a.value * factor, factor * a.by + sign * a.value * b.by};
}

/// The standard deviation of two or more values.
Derived spread(const std::vector<Derived>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, square = 0.0;
  for (const Derived& one : values) mean += one.value / n;
  Derived shown{0.0, Eigen::VectorXd::Zero(values.front().by.size())};
  for (const Derived& one : values) {
    square += (one.value - mean) * (one.value - mean) / (n - 1.0);
    shown.by += (one.value - mean) / (n - 1.0) * one.by;
  }
  shown.value = std::sqrt(square);
  if (shown.value > 0.0) shown.by /= shown.value;
  return shown;
}

std::string name_of(const TrackSet& set, const Configuration& configuration) {
  const std::string mass = fmt::format("{:.6g} kg", set.masses[configuration.mass].mass_kg);
  if (set.groups.size() == 1) return mass;
  const std::string group = own_name(set, configuration.group);
  return set.masses.size() == 1 ? group : group + ", " + mass;
}

/// mu + d or K (1 + d) of each configuration or clip: their standard deviation under the parameter's key, and each
/// under its key of single values, if it has one, followed by a name. Where the drag of air takes the place of K it is
/// c (1 + d), with keys of its own.
std::vector<DiagnosedParameter> own_values(const TrackSet& set, const MotionFit& fit,
                                           const EffectParameter& parameter) {
  const std::vector<std::size_t> globals = fit.layout->all_of(parameter.slot);
  if (globals.size() < 2) return {};
  const FittedSizes sizes(set, fit);
  const bool of_mu = parameter.shown_as == ShownAs::of_mu, of_air = !of_mu && holds_drag(set, fit.effects);
  if (of_air && fit.layout->all_of(kDragOfAir).empty()) return {};  // no drag at all
  const Derived common = of_air ? sizes.at(fit.layout->all_of(kDragOfAir).front()) : sizes.at(of_mu ? kMu : kDrag);
  const std::string_view key = of_air ? "sd_c_kg_m" : parameter.key, each_key = of_air ? "c_kg_m" : parameter.each_key;
  std::vector<Derived> values;
  for (const std::size_t g : globals) {
    values.push_back(of_mu ? sum(common, sizes.at(g)) : enlarged(common, sizes.at(g)));
  }
  std::vector<DiagnosedParameter> shown = {sizes.as(std::string(key), spread(values))};
  for (std::size_t i = 0; i < globals.size() && !parameter.each_key.empty(); ++i) {
    const std::string name = name_of(set, fit.layout->globals()[globals[i]].configuration);
    shown.push_back(sizes.as(fmt::format("{}.{}", each_key, name), values[i]));
  }
  return shown;
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
  const FittedSizes sizes(set, fit);
  const GliderConstants glider{.x_low_m = x.low, .x_high_m = x.high};
  // s is linear in its sizes, so the derivative with respect to a size is s for one unit of that size alone.
  const auto at = [&](double place) {
    Derived shown{0.0, Eigen::VectorXd::Zero(fit.at.global.size())};
    for (std::size_t j = 0; j < globals.size(); ++j) {
      std::vector<double> unit(info.parameters.size(), 0.0);
      unit[j] = 1.0;
      DryFriction of{.mu = 1.0};
      info.law.friction(unit.data(), glider, {place, 0.0, 0.0, 0.0, false}, of);
      shown.by[static_cast<Eigen::Index>(globals[j])] = of.mu - 1.0;
    }
    shown.value = shown.by.dot(fit.at.global);
    return shown;
  };
  const auto place = [&](int i, int of) { return x.low + (x.high - x.low) * (i + 0.5) / of; };
  Derived all{0.0, Eigen::VectorXd::Zero(fit.at.global.size())};
  for (int i = 0; i < kDrawn; ++i) {
    const Derived one = at(place(i, kDrawn));
    all.value += one.value * one.value / kDrawn;
    all.by += one.value / kDrawn * one.by;
  }
  all.value = std::sqrt(all.value);
  if (all.value > 0.0) all.by /= all.value;
  std::vector<DiagnosedParameter> shown = {sizes.as("sd", all)};
  for (int i = 0; i < kPlaces; ++i) {
    shown.push_back(sizes.as(fmt::format("s.at {:.3g} m", place(i, kPlaces)), at(place(i, kPlaces))));
  }
  return shown;
}

}  // namespace

std::string own_name(const TrackSet& set, std::size_t group) {
  const auto named = [&](const TrackGroup& other) { return other.name == set.groups[group].name; };
  if (std::count_if(set.groups.begin(), set.groups.end(), named) == 1) return set.groups[group].name;
  return fmt::format("{} ({:.6g} deg)", set.groups[group].name,
                     set.groups[group].stated_rad * 180.0 / std::numbers::pi);
}

std::vector<DiagnosedParameter> own_sizes(const TrackSet& set, const MotionFit& fit, std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  if (fit.layout->all_of({effect, 0}).empty()) return {};
  std::vector<DiagnosedParameter> shown;
  for (const EffectParameter& parameter : info.parameters) {
    switch (parameter.shown_as) {
      case ShownAs::itself_and_directions: {
        const FittedSizes sizes(set, fit);
        const Derived k = sizes.at(kDrag), d = sizes.at(fit.layout->all_of(parameter.slot).front());
        shown.push_back(sizes.as("k_plus_n_s_m", enlarged(k, d)));
        shown.push_back(sizes.as("k_minus_n_s_m", enlarged(k, d, -1.0)));
        break;
      }
      case ShownAs::of_mu:
      case ShownAs::of_drag: {
        const std::vector<DiagnosedParameter> values = own_values(set, fit, parameter);
        shown.insert(shown.end(), values.begin(), values.end());
        break;
      }
      case ShownAs::along_track: {  // of all parameters together
        const std::vector<DiagnosedParameter> values = friction_along(set, fit, effect);
        shown.insert(shown.end(), values.begin(), values.end());
        return shown;
      }
      case ShownAs::itself:
      case ShownAs::beside_stated:
      case ShownAs::itself_and_middle:
      case ShownAs::place_of_middle:
      case ShownAs::one_more:
      case ShownAs::inverse_root:
        break;
    }
  }
  return shown;
}

}  // namespace glidelab::diagnose
