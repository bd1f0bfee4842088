/// Clips whose friction differs, for the experiments of made_motions.h.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

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

}  // namespace glidelab::tests
