#include "diagnose/causes/recovered.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/math/dense.h"
#include "core/result/estimate.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kUnknownAngle_rad = 0.1, kUnknownMu = 0.3, kUnknownRate = 1.0;  // sd (relative of a rate): not known
constexpr double kNoLoad = 0.02;        // cos(alpha): less than that and no friction is felt
constexpr double kInstant_s = 1e-4;     // over which a speed changes by an acceleration
constexpr double kFastest_m_s = 100.0;  // terminal velocities are sought below
const char* const kWhyTogether = "these motions do not tell it apart from the other quantities";

/// Acceleration at speed v > 0 in the middle of the set-up's track.
double acceleration(TrackModel model, double v_m_s) {
  model.x0_m = model.x_mid_m;
  model.v0_m_s = v_m_s;
  model.known = nullptr;
  model.row_px = {};
  model.effects[slot_of(ids::base_vibration, 0)] = 0.0;
  model.effects[slot_of(ids::late_release, 1)] = 0.0;
  const double times[] = {0.0, kInstant_s};
  return (move(model, times).v_m_s.back() - v_m_s) / kInstant_s;
}

/// The speed at which the force vanishes; none where the glider stops, or never ceases to gain speed.
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

core::Quantity quantity(double value, double sd, double degrees, bool known, const std::string& why) {
  if (!known || !std::isfinite(value) || !std::isfinite(sd)) return core::undetermined(why);
  return core::determined(core::estimate(value, sd, degrees));
}

}  // namespace

std::vector<RecoveredConfiguration> recovered_of(const TrackSet& set, const MotionFit& fit,
                                                 const RemainderSizes& sizes) {
  const RemainderSpace space(set, fit);
  const RemainderSpace::Solution solution = space.solve(sizes);
  MotionFit at = fit;
  at.at.global += solution.change;
  // The scatter from motion to motion is known as well as there are motions.
  const bool scatters = sizes.force_m_s2 > 0.0 || sizes.drag > 0.0;
  const double degrees =
      scatters ? std::max(1.0, static_cast<double>(set.motions.size()) - 1.0) : std::numeric_limits<double>::infinity();
  const auto sd_of = [&](const Eigen::VectorXd& by) {
    const Eigen::VectorXd along = base::product(solution.covariance, by);
    return std::sqrt(std::max(0.0, by.dot(along)));
  };
  const auto& globals = fit.layout->globals();

  std::map<std::pair<std::size_t, std::size_t>, std::size_t> configurations;  // to its first motion
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    configurations.emplace(std::pair(set.motions[i].group, set.motions[i].mass), i);
  }
  std::vector<RecoveredConfiguration> recovered;
  for (const auto& [of, motion] : configurations) {
    const auto& [group, mass] = of;
    // Each quantity as a function of the common parameters, and its derivatives by finite differences.
    const auto gradient = [&](const auto& value) {
      Eigen::VectorXd by = Eigen::VectorXd::Zero(at.at.global.size());
      for (std::size_t g = 0; g < globals.size(); ++g) {
        if (!touches(set, globals[g], motion)) continue;
        const auto k = static_cast<Eigen::Index>(g);
        const double step = std::max(1e-9, 0.01 * std::sqrt(std::max(0.0, solution.covariance(k, k))));
        FitPoint near = at.at;
        near.global[k] += step;
        const double above = value(near);
        near.global[k] -= 2.0 * step;
        by[k] = (above - value(near)) / (2.0 * step);
      }
      return by;
    };
    const auto model_at = [&, i = motion](const FitPoint& point) { return model_of(set, *fit.layout, point, i); };
    const auto rate = [&](const FitPoint& point) { return model_at(point).k_n_s_m / model_at(point).mass_kg; };
    const auto mu = [&](const FitPoint& point) { return model_at(point).mu; };
    const auto alpha = [&](const FitPoint& point) { return model_at(point).alpha_rad; };
    RecoveredConfiguration one;
    one.group = set.groups[group].name;
    one.mass_kg = set.masses[mass].mass_kg;
    one.incline_deg = set.groups[group].stated_rad / kDegree;
    for (const std::size_t e : fit.effects) one.with.emplace_back(effect_list()[e].id);
    const double k_sd = sd_of(gradient(rate)), mu_sd = sd_of(gradient(mu)), alpha_sd = sd_of(gradient(alpha));
    const double k = rate(at.at), angle = alpha(at.at);
    one.k_over_m_1_s =
        quantity(k, k_sd, degrees, k_sd < std::max(kUnknownRate, kUnknownRate * std::abs(k)), kWhyTogether);
    one.mu = std::cos(angle) > kNoLoad ? quantity(mu(at.at), mu_sd, degrees, mu_sd < kUnknownMu, kWhyTogether)
                                       : core::undetermined("a fall has no normal force, and so no friction");
    one.alpha_deg = quantity(angle / kDegree, alpha_sd / kDegree, degrees, alpha_sd < kUnknownAngle_rad, kWhyTogether);
    const std::optional<double> terminal = terminal_velocity(model_at(at.at));
    if (!terminal) {
      one.v_lim_m_s = core::undetermined("the forces balance at no speed downhill");
    } else {
      // v_lim by what a small change of the acceleration moves it: dv = -da/a'(v).
      const double v = *terminal, apart = 1e-3 * v;
      const double slope =
          (acceleration(model_at(at.at), v + apart) - acceleration(model_at(at.at), v - apart)) / (2.0 * apart);
      const Eigen::VectorXd by = gradient([&](const FitPoint& point) { return acceleration(model_at(point), v); });
      const double sd = sd_of(by) / std::abs(slope);
      one.v_lim_m_s = quantity(v, sd, degrees, sd < v, kWhyTogether);
    }
    recovered.push_back(std::move(one));
  }
  return recovered;
}

}  // namespace glidelab::diagnose
