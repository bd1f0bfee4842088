/// The bias that smoothing and ordinary least squares give a line under its own law, so that it can be subtracted.
///
/// A line a = a0 - k v is the law dv/dt = a0 - k v, whose motion in each stretch of one direction is known in closed
/// form (line_law.h) but for x_0, v_0; v_0 is taken from the stretch's smoothed v by least squares. That motion without
/// noise, at the same times, through the same kernels and the same least squares, gives a line (k', a0'); and so
///
///     bias(k, a0) = (k' - k, a0' - a0) + bias of noise in v,      (k, a0) = line - bias(k, a0)  by fixed point.
///
/// (In v a kernel leaves noise of its own, which draws the slope to zero: -(A'A)^-1 (sum of k var v_j + cov(v_j, a_j),
/// 0).) The random covariance of what is left is G C G', G = (1 + d bias / d(k, a0))^-1.
///
/// It holds where the law does: the smoothed points must lie about the law's own smoothed points no further than the
/// noise explains (chi2_ratio_limit), and the bias of k must be less than half of k, or of two of its
/// standard deviations. Otherwise, and with a known force (v then obeys no such law), there is nothing to take off.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/lines/line_fit.h"

namespace glidelab::core {

/// For the line that fit_line() gave for this input. Nothing where the law does not hold (see above).
std::optional<LawBias> law_bias(const LineInput& input, const LineFit& line, const std::vector<double>& autocovariance);

/// The line with its bias taken off (itself where there is none to take off), its uncertainty with what is left.
LineFit without_law_bias(LineFit line);

}  // namespace glidelab::core
