/// sin(2 pi f z) and cos(2 pi f z) at many z for one f after the other, f, f + step, f + 2 step, …: the addition
/// theorems turn each pair on, which costs a tenth of a new sine and cosine. Rounding grows by about 1e-16 a step.
#pragma once

#include <Eigen/Core>

#include <span>

namespace glidelab::diagnose {

class TurningWaves {
 public:
  /// z, and 1/f and 1/step in the unit of z.
  TurningWaves(std::span<const double> z, double f, double step);

  const Eigen::ArrayXd& sin() const { return sin_; }
  const Eigen::ArrayXd& cos() const { return cos_; }
  /// Goes on to f + step.
  void turn();

 private:
  Eigen::ArrayXd sin_, cos_, step_sin_, step_cos_;
};

}  // namespace glidelab::diagnose
