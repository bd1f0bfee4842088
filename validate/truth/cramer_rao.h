/// How precisely a motion can determine K/m, mu, alpha and v_lim at all: the Cramér-Rao bound.
///
/// Positions x_i have independent normal noise with one standard deviation s per clip. The paper's (8) holds with k =
/// K/m, drive d = g sin(alpha) and friction f = mu g cos(alpha) for all clips of one configuration, and each clip has
/// its own start (x0, v0); none of these is known a priori:
///
///     F = sum over clips of J'(1 - P)J / s^2,   J = dx/d(k, d, f),   P projects on dx/d(x0, v0);
///     least variance of q(k, d, f) = grad q' F^-1 grad q.
///
/// The derivatives are those of the true motion (sim/sensitivity/sensitivity.h), through its reversals. Frames in which
/// the glider has finally stopped are not counted: no estimator here uses them.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "validate/truth/truth_folder.h"

namespace glidelab::validate {

/// The bounds of one configuration; a quantity that the motion does not determine, or the truth does not have, is
/// empty.
struct LeastSd {
  std::string configuration;
  std::optional<double> k_over_m_1_s;
  std::optional<double> mu;
  std::optional<double> alpha_deg;
  std::optional<double> v_lim_m_s;
};

/// `noise_sd_m` of each clip of the truth, above 0. Only k and v_lim have a bound if all motion is in one direction,
/// and in a fall (core::is_fall()): it has hardly a normal force for mu, and its drive hardly depends on alpha.
std::vector<LeastSd> least_sds(const Truth& truth, const std::vector<double>& noise_sd_m, double gravity_m_s2);

/// The bound of one of core::kQuantities, by its key and in its unit; empty if the motions do not determine it.
/// std::logic_error for any other key.
std::optional<double> least_sd_of(const LeastSd& least, std::string_view quantity);

}  // namespace glidelab::validate
