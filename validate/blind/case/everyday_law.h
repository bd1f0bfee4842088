/// The true values of each configuration of an everyday experiment, with its causes part of the law.
///
/// K, mu and alpha are the parameters of effects.md besides the cause's own: K of each configuration under
/// configuration_drag and at the middle of the data under damping_gradient, mu of each under configuration_friction,
/// alpha at the middle under track_bow. The terminal velocity is the lowest v > 0 at which drive, drag and friction
/// balance with the causes that are laws of speed or configuration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result/quantity.h"
#include "validate/blind/case/blind_strength.h"

namespace glidelab::validate {

/// K/m, mu, alpha and terminal velocity of clips of one mass and one group, with the causes in the law.
struct EverydayConfiguration {
  std::string group;
  double mass_kg = 0.0, incline_deg = 0.0;  ///< as stated
  double k_over_m_1_s = 0.0, mu = 0.0, alpha_deg = 0.0;
  std::optional<double> v_lim_m_s;  ///< empty if it comes to rest, or has none
};

/// Empty if there is none.
std::optional<double> true_value(const EverydayConfiguration& of, core::Measurand which);

/// The values of every configuration that has a clip, in the order of the clips. `x_m`: positions of each clip.
std::vector<EverydayConfiguration> everyday_configurations(const BlindDesign& design,
                                                           const std::vector<BlindPut>& causes,
                                                           const std::vector<std::vector<double>>& x_m);

}  // namespace glidelab::validate
