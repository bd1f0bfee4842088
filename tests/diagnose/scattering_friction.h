/// Clips whose friction differs, for the experiments of made_motions.h.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "tests/diagnose/made_motions.h"

namespace glidelab::tests {

/// The force of a friction that differs from the glider's by parts of `mu` m g, a part for each clip in turn. Clips
/// follow one another, so a time before the last one begins the next clip.
class ScatteringFriction {
 public:
  ScatteringFriction(double mu, std::vector<double> parts) : mu_(mu), parts_(std::move(parts)) {}

  double operator()(double mass_kg, double v_m_s, double t_s) {
    if (t_s < before_s_ - 0.1) ++clip_;
    before_s_ = t_s;
    const double friction = parts_[part()] * mu_ * mass_kg * 9.80665;
    return v_m_s > 0.0 ? -friction : v_m_s < 0.0 ? friction : 0.0;
  }
  /// Index of the clip's part.
  std::size_t part() const { return (clip_ - 1) % parts_.size(); }

 private:
  double mu_;
  std::vector<double> parts_;
  std::size_t clip_ = 0;
  double before_s_ = 1.0;
};

/// Two masses that run into a soft bumper, -25 N/m (x - 0.35 m) beyond 0.35 m, with a friction that differs by some 5 %
/// between the clips.
inline MadeExperiment made_with_bumper() {
  ScatteringFriction friction(0.02, {0.05, -0.04, 0.03, -0.06});
  MadeEffect both;
  both.force = [&](double m, double x, double v, double t) {
    return friction(m, v, t) - (x > 0.35 ? 25.0 * (x - 0.35) : 0.0);
  };
  const std::vector<MadeLaunch> launches = {
      {0.3, 3.0, 0.2, -1.0}, {0.3, 3.0, -0.6, 0.5}, {0.5, 3.0, 0.2, -0.9}, {0.5, 3.0, -0.6, 0.6}};
  return made_experiment(launches, both, 3, 1.5e-4, 160, 40.0, 0.05, 0.0, {.mu = 0.02});
}

}  // namespace glidelab::tests
