#include "core/outliers.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace glidelab::core {
namespace {

constexpr std::size_t kNeighbours = 10;
constexpr int kAllowedAmongNeighbours = 2;
constexpr double kThreshold = 6.0;

struct Prediction {
  double off = 0.0;        // of the point from the neighbours' cubic
  double gain = 0.0;       // variance of the prediction in units of the noise's
  double scatter = 0.0;    // standard deviation of the neighbours about their cubic
  std::size_t worst = 0;   // the neighbour that lies off most
  double worst_off = 0.0;  // by how much
};

Prediction predict(const Motion& motion, std::size_t j, const std::vector<std::size_t>& neighbours) {
  const auto n = static_cast<Eigen::Index>(neighbours.size());
  Eigen::Matrix<double, Eigen::Dynamic, 4, 0, kNeighbours, 4> design(n, 4);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNeighbours, 1> y(n);
  const double span = std::max(std::abs(motion.t_s[neighbours.front()] - motion.t_s[j]),
                               std::abs(motion.t_s[neighbours.back()] - motion.t_s[j]));
  for (Eigen::Index r = 0; r < n; ++r) {
    const std::size_t i = neighbours[static_cast<std::size_t>(r)];
    const double u = (motion.t_s[i] - motion.t_s[j]) / span;
    design.row(r) << 1.0, u, u * u, u * u * u;
    y[r] = motion.y_m[i] - motion.y_m[j];
  }
  const Eigen::Matrix4d inverse = (design.transpose() * design).inverse();
  const Eigen::Vector4d fit = inverse * (design.transpose() * y);
  const auto residual = (y - design * fit).eval();
  Prediction prediction;
  prediction.off = std::abs(fit[0]);
  prediction.gain = inverse(0, 0);
  prediction.scatter = std::sqrt(residual.squaredNorm() / static_cast<double>(n - 4));
  Eigen::Index worst = 0;
  prediction.worst_off = residual.cwiseAbs().maxCoeff(&worst);
  prediction.worst = static_cast<std::size_t>(worst);
  return prediction;
}

bool is_outlier(const Motion& motion, std::size_t j, const std::vector<char>& dropped) {
  std::vector<std::size_t> neighbours;
  for (std::size_t reach = 1; neighbours.size() < kNeighbours; ++reach) {
    const bool left = j >= reach, right = j + reach < motion.t_s.size();
    if (!left && !right) break;
    if (left && !dropped[j - reach]) neighbours.insert(neighbours.begin(), j - reach);
    if (right && !dropped[j + reach] && neighbours.size() < kNeighbours) neighbours.push_back(j + reach);
  }
  for (int without = 0; neighbours.size() >= 6; ++without) {
    const Prediction prediction = predict(motion, j, neighbours);
    const double scale = std::max(motion.noise_m, prediction.scatter) * std::sqrt(1.0 + prediction.gain);
    if (prediction.off > kThreshold * scale) return true;
    // Neighbours that agree, or too many that do not: the point is no worse than they are.
    if (without == kAllowedAmongNeighbours || prediction.scatter < 3.0 * motion.noise_m) return false;
    neighbours.erase(neighbours.begin() + static_cast<std::ptrdiff_t>(prediction.worst));
  }
  return false;
}

}  // namespace

std::vector<std::size_t> find_outliers(const Motion& motion) {
  std::vector<std::size_t> outliers;
  if (!(motion.noise_m > 0.0)) return outliers;
  std::vector<char> dropped(motion.t_s.size(), 0);
  for (std::size_t j = 0; j < motion.t_s.size(); ++j) {
    if (!is_outlier(motion, j, dropped)) continue;
    dropped[j] = 1;
    outliers.push_back(j);
  }
  return outliers;
}

}  // namespace glidelab::core
