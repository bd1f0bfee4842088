#include "fit/trajectory/trajectory_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/math/angles.h"
#include "core/math/quantile.h"
#include "core/motion/lines/mu_and_alpha.h"
#include "core/motion/steady_fall.h"
#include "core/result/estimate.h"

namespace glidelab::fit {
namespace {

/// `stated_variance`: of what is stated besides the motion, such as gravity.
core::Quantity quantity_of(const TrajectoryFit& fit, double value, const Eigen::VectorXd& gradient,
                           double stated_variance = 0.0) {
  const double random = gradient.dot(fit.covariance * gradient);
  double known = stated_variance;
  for (const Eigen::VectorXd& shift : fit.shared) known += std::pow(gradient.dot(shift), 2);
  return core::determined(core::estimate(value, core::KnownVariance{random, fit.degrees}, known), std::sqrt(random));
}

core::Quantity limit_velocity(const TrajectoryFit& fit, const core::Estimate& k, double a0,
                              const Eigen::VectorXd& by_a0) {
  if (fit.direction < 0) return core::undetermined(core::unknown::NoDownhillMotion{});
  const core::Estimate intercept = *quantity_of(fit, a0, by_a0).estimate;
  if (const auto why_not = core::why_no_limit_velocity(k, {.of_line = false}, intercept)) {
    return core::undetermined(*why_not);
  }
  Eigen::VectorXd gradient = by_a0 / k.value;
  gradient[0] = -a0 / (k.value * k.value);
  return quantity_of(fit, a0 / k.value, gradient);
}

void fill(const TrajectoryFit& fit, const core::AnalysisResults& results, core::ConfigurationResult& result) {
  const double gravity_m_s2 = results.gravity_m_s2;
  const auto of_gravity = [&](double by_gravity) { return std::pow(by_gravity * results.gravity_sd_m_s2, 2); };
  const double k = fit.parameters[0];
  Eigen::VectorXd by_k = Eigen::VectorXd::Zero(fit.parameters.size());
  by_k[0] = 1.0;
  result.k_over_m_1_s = quantity_of(fit, k, by_k);
  const core::Estimate& k_estimate = *result.k_over_m_1_s.estimate;
  if (fit.direction != 0) {
    Eigen::VectorXd by_a0 = Eigen::Vector2d(0.0, 1.0);
    const core::Estimate a0 = *quantity_of(fit, fit.parameters[1], by_a0).estimate;
    core::unknown::OneDirection one_way{fit.direction, a0.value, a0.sd};
    result.alpha_deg = core::undetermined(one_way);
    if (const auto mu = core::mu_of_one_direction(result, fit.direction, a0.value, gravity_m_s2)) {
      const double stated = mu->of_incline * mu->of_incline + of_gravity(mu->by_gravity);
      result.mu = quantity_of(fit, mu->value, mu->by_a0 * by_a0, stated);
    } else {
      one_way.incline_would_do = core::incline_would_do(result);
      result.mu = core::undetermined(one_way);
    }
    result.v_lim_m_s = limit_velocity(fit, k_estimate, a0.value, by_a0);
    return;
  }
  const double drive = fit.parameters[1], friction = fit.parameters[2];
  result.v_lim_m_s = limit_velocity(fit, k_estimate, drive - friction, Eigen::Vector3d(0.0, 1.0, -1.0));
  if (!(std::abs(drive) < gravity_m_s2)) {
    result.alpha_deg = result.mu = core::undetermined(core::unknown::DriveBeyondGravity{});
    return;
  }
  const double cosine = std::sqrt(1.0 - std::pow(drive / gravity_m_s2, 2));
  const double alpha_by_drive = 1.0 / (gravity_m_s2 * cosine);
  const double alpha_by_gravity = -alpha_by_drive * drive / gravity_m_s2;
  result.alpha_deg = quantity_of(fit, std::asin(drive / gravity_m_s2) * base::kDegreesPerRad,
                                 Eigen::Vector3d(0.0, alpha_by_drive * base::kDegreesPerRad, 0.0),
                                 of_gravity(alpha_by_gravity * base::kDegreesPerRad));
  // mu = f / (g cos(alpha)) = f / sqrt(g^2 - d^2); d mu / d alpha = mu tan(alpha)
  const double mu = friction / (gravity_m_s2 * cosine);
  const double mu_by_drive = mu * drive / gravity_m_s2 / cosine * alpha_by_drive;
  const double mu_by_gravity = -mu / (gravity_m_s2 * cosine * cosine);
  result.mu =
      quantity_of(fit, mu, Eigen::Vector3d(0.0, mu_by_drive, 1.0 / (gravity_m_s2 * cosine)), of_gravity(mu_by_gravity));
}

/// k, d, f from the lines; without lines, a glider without friction.
Eigen::Vector3d start_of(const core::ConfigurationResult& result) {
  double k = 0.0;
  for (const core::LineFit& line : result.lines) {
    k += line.k_over_m_1_s.value / static_cast<double>(result.lines.size());
  }
  if (result.lines.size() == 2) {
    const double minus = result.lines[0].a0_m_s2.value, plus = result.lines[1].a0_m_s2.value;
    return {k, 0.5 * (minus + plus), 0.5 * (minus - plus)};
  }
  return {k, result.lines.empty() ? 0.0 : result.lines.front().a0_m_s2.value, 0.0};
}

void note_fit(const TrajectoryFit& fit, const TrajectoryOptions& options, core::ConfigurationResult& result) {
  if (options.robust) {
    result.notes.emplace_back(core::RobustFit{fit.left_out, fit.points + fit.left_out});
  }
  if (std::isfinite(fit.degrees)) {
    if (fit.scatters) result.scatter = fit.scatter;
    result.notes.emplace_back(core::FitScatters{fit.scatter, fit.degrees, fit.by_jackknife});
  }
}

std::vector<FitBlock> blocks_of(const core::AnalysisResults& results, const core::ConfigurationResult& of) {
  std::vector<FitBlock> blocks;
  for (const core::ClipResult& clip : results.clips) {
    if (std::find(of.clips.begin(), of.clips.end(), clip.name) == of.clips.end()) continue;
    for (const core::FreeBlock& block : clip.blocks) {
      blocks.push_back({&block, clip.noise_autocovariance_m2, clip.scale_sd_relative});
    }
  }
  return blocks;
}

void leave_out(const core::AnyReason& why, core::ConfigurationResult& result) {
  result.k_over_m_1_s = result.mu = result.alpha_deg = result.v_lim_m_s = core::undetermined(why);
}

}  // namespace

core::AnalysisResults with_trajectory_fits(core::AnalysisResults results, const TrajectoryOptions& options) {
  for (const core::ClipResult& clip : results.clips) {
    if (!clip.speed_noise_m_s) continue;
    throw base::InputError(base::Issue{"", 0, fmt::format("clip \"{}\": estimator", clip.name),
                                       fmt::format("{} for speeds without positions", kTrajectory),
                                       fmt::format("--estimator {}", name_of(core::LineMethod::ordinary))});
  }
  results.estimator = kTrajectory;
  for (core::ConfigurationResult& configuration : results.configurations) {
    const std::vector<FitBlock> blocks = blocks_of(results, configuration);
    if (blocks.empty()) {
      leave_out(core::unknown::NoFreeMotion{}, configuration);
      continue;
    }
    const auto fit = fit_trajectories(blocks, start_of(configuration), options);
    if (!fit) {
      leave_out(core::unknown::NoFit{}, configuration);
      continue;
    }
    fill(*fit, results, configuration);
    core::note_mu_from_incline(configuration);
    note_fit(*fit, options, configuration);
  }
  core::add_steady_falls(results.clips, results.gravity_m_s2, results.configurations);
  core::note_statements(results.configurations, results.clips, results.gravity_m_s2);
  core::note_gravity(results);
  return results;
}

void set_scatter_of_motion(core::AnalysisResults& results) {
  const bool only_speeds = std::any_of(results.clips.begin(), results.clips.end(),
                                       [](const auto& clip) { return clip.speed_noise_m_s.has_value(); });
  if (only_speeds) return;
  for (core::ConfigurationResult& configuration : results.configurations) {
    const std::vector<FitBlock> blocks = blocks_of(results, configuration);
    if (blocks.empty()) continue;
    const auto fit = fit_trajectories(blocks, start_of(configuration), {});
    if (fit && std::isfinite(fit->degrees) && fit->scatters) configuration.scatter = fit->scatter;
  }
}

}  // namespace glidelab::fit
