#include "diagnose/frames/edge_losses.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFew = 3;                         // positions beyond a gap: of more, the gap shows by itself
constexpr std::size_t kNodes = 5;                       // of the path, which continue it
constexpr int kMostTogether = 5;                        // frames lost at one place
constexpr double kOn = 4.0, kOff = 6.0, kMoves = 10.0;  // standard deviations

/// A motion's path as fitted, for its points from `from` on (`way` +1) or back (-1), continued beyond the first of
/// them.
class Continued {
 public:
  Continued(const TrackedMotion& data, const MotionFit& fit, const std::vector<double>& path_m, std::size_t i,
            std::size_t from, int way) {
    for (std::size_t k = 0; k < kNodes; ++k) {
      const std::size_t p = way > 0 ? from + k : from - k;
      t_s_[k] = data.t_s[p] + (fit.late.empty() ? 0.0 : fit.late[i][p]);
      x_m_[k] = path_m[p];
    }
  }

  double operator()(double t_s) const {  // Lagrange's formula
    double sum = 0.0;
    for (std::size_t a = 0; a < kNodes; ++a) {
      double weight = 1.0;
      for (std::size_t b = 0; b < kNodes; ++b) {
        if (b != a) weight *= (t_s - t_s_[b]) / (t_s_[a] - t_s_[b]);
      }
      sum += weight * x_m_[a];
    }
    return sum;
  }

 private:
  std::array<double, kNodes> t_s_{}, x_m_{};
};

/// Those of one end: `outer` are its outliers, from the motion's end inwards.
bool beyond_gap(const TrackedMotion& data, const Continued& path, const std::vector<std::size_t>& outer, double late_s,
                double step_s, int way) {
  for (int k = 1; k <= kMostTogether; ++k) {
    const bool all = std::all_of(outer.begin(), outer.end(), [&](std::size_t p) {
      const double t = data.t_s[p] + late_s, there = path(t - way * k * step_s), here = path(t);
      const double moved = path(t - way * step_s) - here, sd = data.sd_of(p);
      return std::abs(moved) > kMoves * sd && std::abs(data.x_m[p] - there) < kOn * sd &&
             std::abs(data.x_m[p] - here) > kOff * sd;
    });
    if (all) return true;
  }
  return false;
}

}  // namespace

std::vector<EdgePosition> positions_beyond_gaps(const TrackSet& set, const MotionFit& fit) {
  std::vector<EdgePosition> found;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& data = set.motions[i];
    const std::size_t n = data.t_s.size();
    if (n < 2 * kFew + kNodes) continue;
    const std::vector<double> late = fit.late.empty() ? std::vector<double>(n, 0.0) : fit.late[i];
    std::vector<double> path_m = move(model_of(set, *fit.layout, fit.at, i), data.t_s, late).x_m;
    const std::vector<double> shared = shared_errors(set, *fit.layout, fit.at, i, path_m);
    for (std::size_t p = 0; p < n; ++p) path_m[p] += shared[p];
    const double step_s = 1.0 / set.clips[data.clip].frame_rate_hz;
    for (const int way : {1, -1}) {
      std::vector<std::size_t> outer;
      std::size_t inner = 0;  // how many of the end's positions lie beyond the gap
      for (std::size_t k = 0; k < kFew; ++k) {
        const std::size_t p = way > 0 ? k : n - 1 - k;
        if (!data.outlier[p]) continue;
        outer.push_back(p);
        inner = k + 1;
      }
      if (outer.empty()) continue;
      const std::size_t from = way > 0 ? inner : n - 1 - inner;
      const Continued path(data, fit, path_m, i, from, way);
      if (!beyond_gap(data, path, outer, late[from], step_s, way)) continue;
      for (const std::size_t p : outer) found.push_back({i, p});
    }
  }
  return found;
}

}  // namespace glidelab::diagnose
