#include "diagnose/single_frames/plain_losses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "base/math/dense.h"
#include "core/motion/free/lost_frames.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kPointsOnEachSide = 5;  // points on each side that show a loss by themselves
constexpr Eigen::Index kFewestOfParabolaPoints = 7;
constexpr double kPlainLossGain = 14.0;                                // log likelihood that such a loss gains
constexpr double kMostRestOverNoise = 4.0, kMostRestOverBefore = 0.3;  // of the squares that a loss may leave
constexpr int kMostLostTogether = 5;                                   // frames lost at one place
constexpr int kMostMissingInMotion = 60;                               // in one motion

struct ParabolaRest {
  double square_m2 = 0.0;
  double points = 0.0;  // around the place, outliers not counted
};

/// The residuals of a parabola through the positions around point f, with all from f on later by `shift_s`; empty if
/// there are too few.
ParabolaRest parabola_rest(const TrackedMotion& data, const std::vector<double>& late_s, std::size_t f,
                           double shift_s) {
  const std::size_t from = f - std::min(f, kPointsOnEachSide), to = std::min(data.x_m.size(), f + kPointsOnEachSide);
  const double unit = data.t_s[to - 1] - data.t_s[from];
  Eigen::MatrixXd basis(static_cast<Eigen::Index>(to - from), 3);
  Eigen::VectorXd x(basis.rows());
  Eigen::Index row = 0;
  for (std::size_t p = from; p < to; ++p) {
    if (data.outlier[p]) continue;
    const double t = (data.t_s[p] + late_s[p] - late_s[f] + (p >= f ? shift_s : 0.0) - data.t_s[f]) / unit;
    basis.row(row) << 1.0, t, t * t;
    x[row++] = data.x_m[p] - data.x_m[f];
  }
  const auto points = static_cast<double>(row);
  if (row < kFewestOfParabolaPoints) return {0.0, points};
  const Eigen::MatrixXd used = basis.topRows(row);
  const Eigen::VectorXd y = x.head(row);
  const Eigen::VectorXd by =
      base::solve_positive(base::transposed_product(used, used), base::transposed_product(used, y));
  return {(y - base::product(used, by)).squaredNorm(), points};
}

}  // namespace

LostBefore plain_losses(const TrackSet& set) {
  LostBefore lost_before;
  for (const TrackedMotion& motion : set.motions) {
    const double step_s = 1.0 / set.clips[motion.clip].frame_rate_hz;
    std::vector<double> late_s(motion.x_m.size(), 0.0);
    for (int found = 0; found < kMostMissingInMotion; ++found) {
      double clearest = kPlainLossGain;
      std::size_t place = 0;
      int lost = 0;
      for (std::size_t f = 2; f + 2 <= motion.x_m.size(); ++f) {
        if (motion.t_s[f] - motion.t_s[f - 1] > 1.5 * step_s) continue;  // the time stamps show this gap
        const double square = motion.sd_of(f) * motion.sd_of(f);
        const double without = parabola_rest(motion, late_s, f, 0.0).square_m2 / square;
        for (int k = 1; k <= kMostLostTogether; ++k) {
          const ParabolaRest rest = parabola_rest(motion, late_s, f, k * step_s);
          const double with = rest.square_m2 / square;
          const bool fits = with < std::max(kMostRestOverNoise * rest.points, kMostRestOverBefore * without);
          const double gain = 0.5 * (without - with);
          if (!fits || gain <= clearest) continue;
          clearest = gain;
          place = f;
          lost = k;
        }
      }
      if (lost == 0) break;
      for (std::size_t p = place; p < late_s.size(); ++p) late_s[p] += lost * step_s;
      lost_before.count += static_cast<std::size_t>(lost);
    }
    lost_before.late.push_back(std::move(late_s));
  }
  return lost_before;
}

LostBefore analysed_losses(const TrackSet& set) {
  LostBefore lost_before;
  for (const TrackedMotion& motion : set.motions) {
    const TrackedClip& clip = set.clips[motion.clip];
    const double step_s = 1.0 / clip.frame_rate_hz;
    const auto of_clip = [&](double t) { return core::put_right(t, clip.lost, step_s) - t; };
    std::vector<double> late_s;
    for (const double t : motion.t_s) late_s.push_back(of_clip(t) - of_clip(motion.t_s.front()));
    lost_before.count += static_cast<std::size_t>(std::lround(late_s.back() / step_s));
    lost_before.late.push_back(std::move(late_s));
  }
  return lost_before;
}

namespace {

constexpr std::size_t kMostBeyondGap = 3;     // positions beyond a gap: with more of them, the gap shows by itself
constexpr std::size_t kNodesOfPath = 5;       // of the path, which continue it
constexpr double kFarthestFromShifted = 4.0;  // standard deviations: of the path a frame or more away,
constexpr double kNearestToPath = 6.0;        // of the path at the stated time,
constexpr double kLeastStep = 10.0;           // and from one frame to the next

/// A motion's path as fitted, for its points from `from` on (`direction` +1) or back (-1), extrapolated beyond the
/// first of them.
class Continued {
 public:
  Continued(const TrackedMotion& data, const MotionFit& fit, const std::vector<double>& path_m, std::size_t i,
            std::size_t from, int direction) {
    for (std::size_t k = 0; k < kNodesOfPath; ++k) {
      const std::size_t p = direction > 0 ? from + k : from - k;
      t_s_[k] = data.t_s[p] + (fit.late.empty() ? 0.0 : fit.late[i][p]);
      x_m_[k] = path_m[p];
    }
  }

  double operator()(double t_s) const {  // Lagrange's formula
    double sum = 0.0;
    for (std::size_t a = 0; a < kNodesOfPath; ++a) {
      double weight = 1.0;
      for (std::size_t b = 0; b < kNodesOfPath; ++b) {
        if (b != a) weight *= (t_s - t_s_[b]) / (t_s_[a] - t_s_[b]);
      }
      sum += weight * x_m_[a];
    }
    return sum;
  }

 private:
  std::array<double, kNodesOfPath> t_s_{}, x_m_{};
};

/// Those of one end: `outer` are its outliers, from the motion's end inwards.
bool beyond_gap(const TrackedMotion& data, const Continued& path, const std::vector<std::size_t>& outer, double late_s,
                double step_s, int direction) {
  for (int k = 1; k <= kMostLostTogether; ++k) {
    const bool all = std::all_of(outer.begin(), outer.end(), [&](std::size_t p) {
      const double t = data.t_s[p] + late_s, there = path(t - direction * k * step_s), here = path(t);
      const double moved = path(t - direction * step_s) - here, sd = data.sd_of(p);
      return std::abs(moved) > kLeastStep * sd && std::abs(data.x_m[p] - there) < kFarthestFromShifted * sd &&
             std::abs(data.x_m[p] - here) > kNearestToPath * sd;
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
    if (n < 2 * kMostBeyondGap + kNodesOfPath) continue;
    const std::vector<double> late = fit.late.empty() ? std::vector<double>(n, 0.0) : fit.late[i];
    std::vector<double> path_m = move(model_of(set, *fit.layout, fit.at, i), data.t_s, late).x_m;
    const std::vector<double> shared = shared_errors(set, *fit.layout, fit.at, i, path_m);
    for (std::size_t p = 0; p < n; ++p) path_m[p] += shared[p];
    const double step_s = 1.0 / set.clips[data.clip].frame_rate_hz;
    for (const int direction : {1, -1}) {
      std::vector<std::size_t> outer;
      std::size_t inner = 0;  // how many of the end's positions lie beyond the gap
      for (std::size_t k = 0; k < kMostBeyondGap; ++k) {
        const std::size_t p = direction > 0 ? k : n - 1 - k;
        if (!data.outlier[p]) continue;
        outer.push_back(p);
        inner = k + 1;
      }
      if (outer.empty()) continue;
      const std::size_t from = direction > 0 ? inner : n - 1 - inner;
      const Continued path(data, fit, path_m, i, from, direction);
      if (!beyond_gap(data, path, outer, late[from], step_s, direction)) continue;
      for (const std::size_t p : outer) found.push_back({i, p});
    }
  }
  return found;
}

}  // namespace glidelab::diagnose
