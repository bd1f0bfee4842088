#include "core/math/parabola.h"

#include <Eigen/Core>
#include <cassert>
#include <cstddef>

#include "base/math/dense.h"

namespace glidelab::core {

double Parabola::at(double t_s) const {
  const double t = t_s - middle_s;
  return middle + v * t + 0.5 * a * t * t;
}

Parabola parabola_through(std::span<const double> t_s, std::span<const double> x) {
  assert(t_s.size() == x.size() && t_s.size() >= 3);
  Eigen::MatrixXd design(static_cast<Eigen::Index>(t_s.size()), 3);
  const double middle_s = 0.5 * (t_s.front() + t_s.back());
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const double t = t_s[static_cast<std::size_t>(i)] - middle_s;
    design.row(i) << 1.0, t, 0.5 * t * t;
  }
  const Eigen::Vector3d fit = base::least_squares(design, Eigen::Map<const Eigen::VectorXd>(x.data(), design.rows()));
  return {middle_s, fit[0], fit[1], fit[2]};
}

}  // namespace glidelab::core
