/// Tables of lines by equation (8) with causes beside it, in closed form.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "diagnose/lines/line_model.h"

namespace glidelab::tests {

inline constexpr double kLineGravity = 9.80665, kLineDrag = 0.93, kLineMu = 0.006;
inline const std::vector<double> kThreeMasses = {0.335, 0.435, 0.535}, kSixMasses = {0.2, 0.3, 0.45, 0.7, 1.0, 1.5};

struct LineCauses {
  double friction_n = 0.0;                                                ///< that no load makes
  double bias_s2_m_s2 = 0.0;                                              ///< of the smoothing, times (K/m)²
  double wheels_kg = 0.0;                                                 ///< inertia that is not weighed
  std::function<double(std::size_t mass, std::size_t setup)> friction{};  ///< more of it, m/s²
  std::function<double(std::size_t mass)> drag{};                         ///< relative
  double scatter = 1.0;                                                   ///< of 1 mm/s² and 0.1 %
};

/// Lines level and at 4 degrees, both ways.
inline std::vector<diagnose::TableLine> lines_with(const LineCauses& causes, unsigned seed,
                                                   const std::vector<double>& masses = kSixMasses) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, causes.scatter);
  std::vector<diagnose::TableLine> lines;
  for (const std::size_t setup : {0u, 1u}) {
    const double degrees = setup == 0 ? 0.0 : 4.0, alpha = degrees * std::numbers::pi / 180.0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      const double mass = masses[i], inert = mass + causes.wheels_kg;
      const double k = kLineDrag / inert * (causes.drag ? 1.0 + causes.drag(i) : 1.0);
      for (const int direction : {-1, 1}) {
        const double weight = mass / inert * kLineGravity;
        const double friction = kLineMu * weight * std::cos(alpha) + causes.friction_n / inert +
                                causes.bias_s2_m_s2 * k * k + (causes.friction ? causes.friction(i, setup) : 0.0);
        lines.push_back({mass, degrees, direction,
                         weight * std::sin(alpha) - direction * friction + 1e-3 * normal(random),
                         k * (1.0 + 1e-3 * normal(random))});
      }
    }
  }
  return lines;
}

}  // namespace glidelab::tests
