/// A parabola through positions, by least squares.
#pragma once

#include <span>

namespace glidelab::core {

/// x = middle + v u + a u²/2, u = t - middle_s, where middle_s lies in the middle of the times.
struct Parabola {
  double middle_s = 0.0;
  double middle = 0.0;
  double v = 0.0;
  double a = 0.0;
  double at(double t_s) const;
};

/// Of at least three points at different times, in order of time.
Parabola parabola_through(std::span<const double> t_s, std::span<const double> x);

}  // namespace glidelab::core
