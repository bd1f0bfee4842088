/// Integrals to nearly the last digit, also of integrands with an infinite slope or a jump of slope at an end: the
/// tanh-sinh rule (Takahasi and Mori 1974). An oracle that shares nothing with the solver.
#pragma once

#include <cmath>
#include <numbers>

namespace glidelab::tests {

/// Integral of f over [0, width].
template <class F>
double integrate(double width, F&& f) {
  constexpr double kStep = 1.0 / 64.0;
  double sum = 0.0;
  for (int i = -6 * 64; i <= 6 * 64; ++i) {
    const double t = i * kStep;
    const double u = 0.5 * std::numbers::pi * std::sinh(t);
    // distance = width / (1 + e^(-2u)), which keeps its digits near 0.
    const double distance = width / (1.0 + std::exp(-2.0 * u));
    const double weight = 0.5 * width * 0.5 * std::numbers::pi * std::cosh(t) / (std::cosh(u) * std::cosh(u));
    if (distance > 0.0 && distance < width && weight > 0.0) sum += weight * f(distance);
  }
  return sum * kStep;
}

}  // namespace glidelab::tests
