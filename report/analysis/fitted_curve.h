/// The motion under the law recovered by an analysis, overlaid on the measured positions of one clip.
///
/// On a stretch in the direction s = sign(v), with k = K/m and a0 = g sin(alpha) - s mu g cos(alpha) (if mu or alpha is
/// not known: the a0 of the configuration's line for that direction),
///
///     dv/dt = a0 - k v
///     x(t) = x0 + v0 phi(t) + a0 psi(t),   phi = (1 - exp(-k t)) / k,   psi = (t - phi) / k
///
/// from the stretch's first instant on. Only x0 and v0 are fitted to its positions, by least squares.
#pragma once

#include <cstddef>
#include <vector>

#include "core/result/results.h"
#include "report/html/plot.h"

namespace glidelab::report {

struct FittedCurve {
  std::vector<double> t_s, x_m;  ///< times of the positions of the stretch, and the law's x at these times
  double rms_m = 0.0;            ///< of measured minus fitted
};

/// One for each stretch of four or more positions in a direction for which the law is known; none under a known force,
/// which acts in addition.
std::vector<FittedCurve> fitted_curves(const core::ClipResult& clip, const core::ConfigurationResult& configuration,
                                       double gravity_m_s2);

/// x(t) of every clip: the positions and the fitted curves over them, clip by clip. Clips without a fitted curve, and
/// those beyond the first `most`, are left out.
std::vector<Plot> fitted_plots(const core::AnalysisResults& results, std::size_t most);

}  // namespace glidelab::report
