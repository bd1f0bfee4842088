/// Gliders and grids of times for the tests of sim/.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "sim/force/law_list.h"
#include "sim/motion/simulate.h"

namespace glidelab::tests {

inline constexpr double kGravity = 9.80665;  // m/s²

template <class... Terms>
sim::Body body(double mass_kg, double incline_rad, Terms... terms) {
  sim::Body result;
  result.mass_kg = mass_kg;
  result.incline_rad = incline_rad;
  result.gravity_m_s2 = kGravity;
  (result.forces.push_back(terms), ...);
  return result;
}

/// 0, step, …, up to and with `end`.
inline std::vector<double> times(double end_s, double step_s) {
  std::vector<double> result;
  for (int i = 0; i * step_s <= end_s * (1.0 + 1e-12); ++i) result.push_back(i * step_s);
  return result;
}

/// Uniform numbers that are the same on every platform.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace glidelab::tests
