/// sin(2 pi f z) and cos(2 pi f z) at many z, for one f after another: f, f + step, f + 2 step, …. The addition
/// theorems advance each pair, which costs a tenth of a new sine and cosine. Rounding errors grow by about 1e-16 a
/// step.
#pragma once

#include <Eigen/Core>

#include <span>

namespace glidelab::diagnose {

class TurningWaves {
 public:
  /// f and step are in the inverse unit of z.
  TurningWaves(std::span<const double> z, double f, double step);

  const Eigen::ArrayXd& sin() const { return sin_; }
  const Eigen::ArrayXd& cos() const { return cos_; }
  /// Advances to f + step.
  void turn();

 private:
  Eigen::ArrayXd sin_, cos_, step_sin_, step_cos_;
};

}  // namespace glidelab::diagnose
