#include "core/motion/free/motion.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/quantile.h"
#include "core/motion/smoothing/noise.h"

namespace glidelab::core {
namespace {

constexpr double kRounding = 1e-12;  // of the largest position: a few thousand epsilon

}  // namespace

Motion motion_of(const TrackData& track, double mass_kg) {
  Motion motion{track.t_s, track.x_m, track.x_m, {}, median_step(track.t_s), 0.0, !track.force_n.empty()};
  motion.point.resize(track.t_s.size());
  std::iota(motion.point.begin(), motion.point.end(), std::size_t{0});
  if (motion.forced) {
    double v = 0.0, x = 0.0;  // of the force's own motion, from rest
    for (std::size_t i = 1; i < track.t_s.size(); ++i) {
      const double dt = track.t_s[i] - track.t_s[i - 1];
      const double before = track.force_n[i - 1] / mass_kg, after = track.force_n[i] / mass_kg;
      x += v * dt + dt * dt * (2.0 * before + after) / 6.0;
      v += 0.5 * dt * (before + after);
      motion.y_m[i] -= x;
    }
  }
  motion.noise_m = pilot_noise(motion.t_s, motion.y_m);
  // Not below the rounding error of sums over a kernel: a constant must not look like a motion.
  for (const double y : motion.y_m) motion.noise_m = std::max(motion.noise_m, kRounding * std::abs(y));
  return motion;
}

Motion without(const Motion& motion, const std::vector<std::size_t>& points) {
  Motion rest;
  rest.step_s = motion.step_s;
  rest.noise_m = motion.noise_m;
  rest.forced = motion.forced;
  for (std::size_t i = 0; i < motion.t_s.size(); ++i) {
    if (std::binary_search(points.begin(), points.end(), i)) continue;
    rest.t_s.push_back(motion.t_s[i]);
    rest.x_m.push_back(motion.x_m[i]);
    rest.y_m.push_back(motion.y_m[i]);
    rest.point.push_back(motion.point[i]);
  }
  return rest;
}

namespace {

constexpr std::size_t kNeighbours = 10;  // on both sides
constexpr int kAllowedAmongNeighbours = 2;
constexpr std::size_t kOneSide = 5;           // neighbours
constexpr double kLeastOutlierSds = 6.0;      // standard deviations
constexpr double kMostDisagreementSds = 3.0;  // standard deviations

struct Prediction {
  double off = 0.0;        // distance of the point from the neighbours' cubic
  double gain = 0.0;       // variance of the prediction over the noise's
  double scatter = 0.0;    // standard deviation of the neighbours about their cubic
  std::size_t worst = 0;   // the neighbour that is farthest off
  double worst_off = 0.0;  // its distance
};

/// By the polynomial of `Coefficients` coefficients through the neighbours.
template <int Coefficients>
Prediction predict(const Motion& motion, std::size_t j, const std::vector<std::size_t>& neighbours) {
  const auto n = static_cast<Eigen::Index>(neighbours.size());
  Eigen::Matrix<double, Eigen::Dynamic, Coefficients, 0, kNeighbours, Coefficients> design(n, Coefficients);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kNeighbours, 1> y(n);
  const double span = std::max(std::abs(motion.t_s[neighbours.front()] - motion.t_s[j]),
                               std::abs(motion.t_s[neighbours.back()] - motion.t_s[j]));
  for (Eigen::Index r = 0; r < n; ++r) {
    const std::size_t i = neighbours[static_cast<std::size_t>(r)];
    const double u = (motion.t_s[i] - motion.t_s[j]) / span;
    double power = 1.0;
    for (int c = 0; c < Coefficients; ++c, power *= u) design(r, c) = power;
    y[r] = motion.y_m[i] - motion.y_m[j];
  }
  const Eigen::Matrix<double, Coefficients, Coefficients> inverse = (design.transpose() * design).inverse();
  const Eigen::Matrix<double, Coefficients, 1> fit = inverse * (design.transpose() * y);
  const auto residual = (y - design * fit).eval();
  Prediction prediction;
  prediction.off = std::abs(fit[0]);
  prediction.gain = inverse(0, 0);
  prediction.scatter = std::sqrt(residual.squaredNorm() / static_cast<double>(n - Coefficients));
  Eigen::Index worst = 0;
  prediction.worst_off = residual.cwiseAbs().maxCoeff(&worst);
  prediction.worst = static_cast<std::size_t>(worst);
  return prediction;
}

/// Whether the motion before the point (step -1) or after it (+1) runs smoothly into it: at an impact one of the two
/// does.
bool continues(const Motion& motion, std::size_t j, int step) {
  std::vector<std::size_t> neighbours;
  for (std::size_t reach = 1; reach <= kOneSide; ++reach) {
    if (step < 0 ? j < reach : j + reach >= motion.t_s.size()) return false;
    neighbours.push_back(step < 0 ? j - reach : j + reach);
  }
  const Prediction prediction = predict<3>(motion, j, neighbours);
  return prediction.scatter < kMostDisagreementSds * motion.noise_m &&
         prediction.off < kMostDisagreementSds * motion.noise_m * std::sqrt(1.0 + prediction.gain);
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
    const Prediction prediction = predict<4>(motion, j, neighbours);
    const double scale = std::max(motion.noise_m, prediction.scatter) * std::sqrt(1.0 + prediction.gain);
    if (prediction.off > kLeastOutlierSds * scale) return !continues(motion, j, -1) && !continues(motion, j, 1);
    // The neighbours agree, or too many do not: the point is no worse than they are.
    if (without == kAllowedAmongNeighbours || prediction.scatter < kMostDisagreementSds * motion.noise_m) return false;
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
