#include "validate/blind/case/everyday_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/math/angles.h"
#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/everyday_causes.h"

namespace glidelab::validate {
namespace {

namespace ids = diagnose::ids;

const std::set<std::string> kLawsOfSpeed = {ids::quadratic_drag,
                                            ids::eddy_rolloff,
                                            ids::power_law_drag,
                                            ids::stribeck,
                                            ids::load_independent_friction,
                                            ids::direction_dependent_drag,
                                            ids::configuration_drag,
                                            ids::configuration_friction};

/// Middle of the range of x over all clips of a group.
double middle_of(const BlindDesign& design, const std::vector<std::vector<double>>& x_m, std::size_t group) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    if (design.clips[c].group != group) continue;
    for (const double x : x_m[c]) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  return 0.5 * (low + high);
}

/// Terms of the law of a clip with the causes that `of` names.
BlindTerms law_terms(const BlindDesign& design, std::size_t clip, const std::vector<BlindPut>& causes,
                     const std::set<std::string>& of, double x, double v) {
  BlindFilm film = nominal_film(design, design.clips[clip]);
  const double weight = film.law.mass_kg * film.law.gravity_m_s2;
  for (const BlindPut& put : causes) {
    if (of.contains(put.effect->id)) put.effect->put(put.size, clip, film);
  }
  BlindTerms terms{weight * std::sin(film.law.alpha_rad), film.law.k_n_s_m * v,
                   film.law.mu * weight * std::cos(film.law.alpha_rad), film.law.mass_kg, film.law.mass_kg};
  for (const BlindChange& change : film.law.changes) change(x, v, 0.0, terms);
  return terms;
}

/// The first root of `net` above rest; empty if the glider does not set off, or if nothing limits it below 50 m/s.
std::optional<double> first_balance(const std::function<double(double)>& net) {
  constexpr double kSlowest = 1e-6, kFastest = 50.0, kStep = 0.01;  // m/s
  constexpr int kRootHalvings = 60;
  if (!(net(kSlowest) > 0.0)) return std::nullopt;
  double low = kSlowest;
  for (double high = kStep; high < kFastest; high += kStep) {
    if (net(high) > 0.0) {
      low = high;
      continue;
    }
    for (int i = 0; i < kRootHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (net(middle) > 0.0 ? low : high) = middle;
    }
    return low;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> true_value(const EverydayConfiguration& of, core::Measurand which) {
  switch (which) {
    case core::Measurand::k_over_m:
      return of.k_over_m_1_s;
    case core::Measurand::mu:
      return of.mu;
    case core::Measurand::alpha:
      return of.alpha_deg;
    default:
      return of.v_lim_m_s;
  }
}

std::vector<EverydayConfiguration> everyday_configurations(const BlindDesign& design,
                                                           const std::vector<BlindPut>& causes,
                                                           const std::vector<std::vector<double>>& x_m) {
  constexpr double kAnySpeed = 1.0;
  std::vector<EverydayConfiguration> list;
  std::set<std::size_t> seen;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    const BlindClip& clip = design.clips[c];
    if (!seen.insert(configuration_of(design, clip)).second) continue;
    const BlindGroup& group = design.groups[clip.group];
    const double mass = design.masses[clip.mass].true_kg, weight = mass * design.gravity_m_s2;
    const double middle = middle_of(design, x_m, clip.group);
    const auto terms = [&](const std::set<std::string>& of, double v) {
      return law_terms(design, c, causes, of, middle, v);
    };
    EverydayConfiguration one;
    one.group = group.name;
    one.mass_kg = design.masses[clip.mass].stated_kg;
    one.incline_deg = group.stated_rad / base::kRadPerDegree;
    one.k_over_m_1_s = terms({ids::configuration_drag, ids::damping_gradient}, kAnySpeed).drag_n / kAnySpeed / mass;
    one.mu = terms({ids::configuration_friction}, kAnySpeed).friction_n / (weight * std::cos(group.true_rad));
    const double drive = terms({ids::track_bow}, kAnySpeed).drive_n;
    one.alpha_deg = std::asin(std::clamp(drive / weight, -1.0, 1.0)) / base::kRadPerDegree;
    std::set<std::string> of = kLawsOfSpeed;
    of.insert({ids::track_bow, ids::damping_gradient, ids::direction_asymmetry});
    one.v_lim_m_s = first_balance([&](double v) {
      const BlindTerms at = terms(of, v);
      return at.drive_n - at.drag_n - std::max(0.0, at.friction_n);
    });
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace glidelab::validate
