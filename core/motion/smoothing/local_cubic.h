/// The local cubic with a Gaussian kernel: x, v and a at a time from measured positions (paper, equations 10 to 12).
/// The paper's case of local_polynomial.h; u = t_i - t turns its sign, so that c is v.
///
/// The kernel is cut off at kKernelReach = 6 bandwidths, where its weight is 1.5e-8 and what is left out changes a by
/// less than 1e-5 of the kernel's own smoothing. With uniform times of step dt, far from an end and for h of several dt
/// (white noise of standard deviation s; Fan and Gijbels 1996, section 3.2):
///
///     var x = 0.4760 s^2 dt / h      var v = 0.4849 s^2 dt / h^3     var a = 0.2116 s^2 dt / h^5
///     bias x = -h^4 x''''/8          bias v = -h^4 x'''''/8          bias a = h^2 x''''/2
#pragma once

#include <span>

#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

/// The smoother of one set of times, which rise strictly; bandwidth above 0 (asserted).
class LocalCubic : public LocalPolynomial {
 public:
  LocalCubic(std::span<const double> t_s, double bandwidth_s) : LocalPolynomial(t_s, options_of(bandwidth_s)) {}

 private:
  static PolynomialOptions options_of(double bandwidth_s) {
    PolynomialOptions options;
    options.bandwidth_s = bandwidth_s;
    return options;
  }
};

}  // namespace glidelab::core
