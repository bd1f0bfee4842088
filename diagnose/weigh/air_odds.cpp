#include "diagnose/weigh/air_odds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/gap/held_out.h"

namespace glidelab::diagnose {
namespace {

constexpr double kViscousOdds = 0.05, kDrivingOdds = 0.001;
constexpr double kDecades = 9.2;    // ln 10^4
constexpr double kLeastSeen = 2.0;  // standard deviations
constexpr double kMostAirAlong_kg = 0.011;
constexpr double kImpossible = 1e-9;
constexpr double kNeitherOdds = 0.001;      // an inertia that is too large for air, and for certain of no wheel
constexpr double kDragAndWheelOdds = 0.05;  // two causes that have nothing to do with one another

/// Whether the inertia of a fit is larger than that of air, by so many standard deviations.
bool exceeds_air(const TrackSet& set, const MotionFit& fit, double sds) {
  const std::size_t g = fit.layout->first_of(effect_index(ids::rotational_inertia));
  if (g == fit.layout->globals().size()) return false;
  const auto at = static_cast<Eigen::Index>(g);
  const double sd_kg = std::sqrt(std::max(0.0, common_covariance(fit)(at, at)));
  const double most_kg = set.mass_assumed ? kMostAirAlong_masses * lightest_kg(set) : kMostAirAlong_kg;
  return fit.at.global[at] - sds * sd_kg > most_kg;
}

bool turns_a_wheel(const TrackSet& set, const MotionFit& fit) {
  return exceeds_air(set, fit, kLeastSeen);
}

/// Whether the viscous drag of a fit bears half of a body's weight or more.
bool is_near_terminal(const TrackSet& set, const MotionFit& fit) {
  constexpr double kHalf = 0.5;
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const double weight_n = set.masses[set.motions[i].mass].mass_kg * set.gravity_m_s2;
    for (const double v : fit.motions[i].v_m_s) {
      if (fit.at.global[0] * std::abs(v) > kHalf * weight_n) return true;
    }
  }
  return false;
}

}  // namespace

double log_odds_without_air(const TrackSet& set, const MotionFit& fit) {
  const auto has_drag = [&](Drag drag) {
    return std::any_of(fit.effects.begin(), fit.effects.end(),
                       [&](std::size_t e) { return effect_list()[e].drag == drag; });
  };
  if (!set.through_air) return 0.0;
  if (has_drag(Drag::of_air)) return turns_a_wheel(set, fit) ? std::log(kDragAndWheelOdds) : 0.0;
  // A drag of some other kind, or the air that moves along with what it does not brake.
  const bool adds_inertia =
      std::find(fit.effects.begin(), fit.effects.end(), effect_index(ids::rotational_inertia)) != fit.effects.end();
  if (adds_inertia && exceeds_air(set, fit, 0.0) && is_near_terminal(set, fit)) return std::log(kImpossible);
  if (adds_inertia && !turns_a_wheel(set, fit)) {
    return std::log(exceeds_air(set, fit, 0.0) ? kNeitherOdds : kViscousOdds);
  }
  if (has_drag(Drag::viscous)) return std::log(kViscousOdds);
  const double sd = std::sqrt(std::max(0.0, common_covariance(fit)(0, 0)));
  const double z = sd > 0.0 ? fit.at.global[0] / sd : 0.0;
  const double without =
      kDecades * std::max(std::abs(z), kLeastSeen) / std::sqrt(2.0 * std::numbers::pi) * std::exp(-0.5 * z * z);
  return std::log((z > 0.0 ? kViscousOdds : kDrivingOdds) + without);
}

bool too_strong_for_air(const TrackSet& set, const Comparison& comparison) {
  if (set.mass_assumed) return false;
  constexpr double kMostOfAir_kg_m = 0.6;
  const EffectSlot slot = slot_of(ids::quadratic_drag);
  for (const MotionFit& fit : comparison.fits) {
    if (fit.effects != std::vector<std::size_t>{slot.effect} || !fit.layout) continue;
    const auto& globals = fit.layout->globals();
    for (std::size_t g = 0; g < globals.size(); ++g) {
      if (globals[g].parameter != nullptr && globals[g].effect == slot.effect)
        return fit.at.global[static_cast<Eigen::Index>(g)] > kMostOfAir_kg_m;
    }
  }
  return false;
}

}  // namespace glidelab::diagnose
