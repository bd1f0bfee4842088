#include "diagnose/model/turning_waves.h"

#include <numbers>

namespace glidelab::diagnose {

TurningWaves::TurningWaves(std::span<const double> z, double f, double step) {
  const Eigen::Map<const Eigen::ArrayXd> at(z.data(), std::ssize(z));
  constexpr double kTurn = 2.0 * std::numbers::pi;
  sin_ = (kTurn * f * at).sin();
  cos_ = (kTurn * f * at).cos();
  step_sin_ = (kTurn * step * at).sin();
  step_cos_ = (kTurn * step * at).cos();
}

void TurningWaves::turn() {
  const Eigen::ArrayXd sine = sin_ * step_cos_ + cos_ * step_sin_;
  cos_ = cos_ * step_cos_ - sin_ * step_sin_;
  sin_ = sine;
}

}  // namespace glidelab::diagnose
