/// How strongly a motion was smoothed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result/strength_choice.h"

namespace glidelab::core {

/// What a smoother (core/motion/smoothing/smoother.h) chose.
struct SmoothingStrength {
  std::string smoother = "local-polynomial";
  StrengthChoice method;     ///< how it was chosen
  int order = 0;             ///< N of the process (wiener_chain.h); 0 if there is none
  double rate_1_s = 0.0;     ///< k, at which its last derivative decays
  double bandwidth_s = 0.0;  ///< of the local cubic; otherwise of the local cubic with the same noise in a, far from
                             ///< ends
  double noise_sd_m = 0.0;   ///< of a position of factor 1, if the smoother needs it; 0 otherwise
  /// For the integrated Wiener process of order N (wiener_chain.h): (s^2 dt / q)^(1 / 2N), dt the mean time step.
  /// Oscillations of x faster than 1/time_s in angular frequency are taken for noise.
  double time_s = 0.0;
  std::optional<double> jump_sd_m_s2;  ///< of a at a break; infinite if any jump is allowed
  std::vector<double> breaks_s;        ///< where a may jump, as estimated
  double parameters = 0.0;             ///< effective number of parameters: the trace of the smoothing matrix
  /// a ± this times its standard deviation contains a at all frames simultaneously with 95 % probability, if that is
  /// known.
  std::optional<double> simultaneous_a;
};

}  // namespace glidelab::core
