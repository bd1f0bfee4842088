/// The line a = a0 - (K/m) v by generalised least squares: smoothed points with their known covariance, errors in both
/// v and a, and no kernel bias.
///
/// Ordinary least squares (line_fit.h) gives every smoothed point the same weight, although neighbours share their
/// noise and a sum of a over many points is known far better than its parts. It leaves out the points near ends and
/// reversals, which carry most information. It keeps the kernel's bias, and noise in v pulls its slope towards zero.
/// Here, for stretches smoothed with their own points alone (one-sided at ends and events), nodes about one bandwidth
/// apart are taken, end to end, with
///
///     rho_j = a_j + k v_j - a0 p_j(k) - v0 q_j(k),     C(k) = (W_a + k W_v) Sigma (W_a + k W_v)',
///
/// W_a, W_v the kernels' weights and Sigma the noise of the positions, and  rho' C(k)^-1 rho  is minimised over k and
/// a0. For normal noise this is maximum likelihood with the true v_j free: it accounts for errors in both v and a and
/// for their covariances. (Points closer than a bandwidth only make C ill-conditioned; at twice that spacing,
/// information is lost.)
///
/// The kernel's bias: in a stretch under the line's own law x = x_0 + v0 phi(t) + a0 psi(t), with
///
///     phi = (1 - exp(-k t))/k,   psi = (t - phi)/k,   p = (W_a + k W_v) psi,   q = (W_a + k W_v) phi,
///
/// and without bias p = 1, q = 0. v0 is taken from the smoothed v. With a known force, v obeys no such law: p = 1, q =
/// 0, and the bias of `law` is stated as an uncertainty, as line_fit.h does.
///
/// Covariance (A' C^-1 A)^-1, A = -d rho / d(k, a0). If chi^2 exceeds its degrees of freedom by more than chance allows
/// (the law is not a line), the covariance grows by the scatter of blocks of whitened residuals, as in line_fit.h. With
/// four stretches or more it is compared with the jackknife over stretches, also as in line_fit.h.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/free/motion.h"
#include "core/motion/lines/gls_pieces.h"
#include "core/result/results.h"

namespace glidelab::core {

/// LineFit::points counts the positions on which the line rests; r2 is that of the nodes. Empty if no piece of the
/// direction is four bandwidths long, or if the search does not settle.
std::optional<LineFit> fit_line_gls(int direction, const Motion& motion, const std::vector<FreePiece>& pieces,
                                    const GlsInput& input);

}  // namespace glidelab::core
