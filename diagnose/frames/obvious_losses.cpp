#include "diagnose/frames/obvious_losses.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/math/dense.h"
#include "core/motion/free/lost_frames.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kAround = 5;  // points on each side that show a loss by themselves
constexpr Eigen::Index kFewestAround = 7;
constexpr double kPlainLossGain = 14.0;     // log likelihood that such a loss gains
constexpr double kFits = 4.0, kMuch = 0.3;  // what it may leave: of the noise's squares, or of what was left before
constexpr int kMostLostTogether = 5;        // frames lost at one place
constexpr int kMostMissingInMotion = 60;    // in one motion

struct ParabolaRest {
  double square_m2 = 0.0;
  double points = 0.0;  // around the place, outliers not counted
};

/// What a parabola leaves of the positions around point f, all from f on later by `shift_s`; nothing where there are
/// too few.
ParabolaRest parabola_rest(const TrackedMotion& data, const std::vector<double>& late_s, std::size_t f,
                           double shift_s) {
  const std::size_t from = f - std::min(f, kAround), to = std::min(data.x_m.size(), f + kAround);
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
  if (row < kFewestAround) return {0.0, points};
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
        if (motion.t_s[f] - motion.t_s[f - 1] > 1.5 * step_s) continue;  // the stamps tell of it
        const double square = motion.sd_of(f) * motion.sd_of(f);
        const double without = parabola_rest(motion, late_s, f, 0.0).square_m2 / square;
        for (int k = 1; k <= kMostLostTogether; ++k) {
          const ParabolaRest rest = parabola_rest(motion, late_s, f, k * step_s);
          const double with = rest.square_m2 / square;
          const bool fits = with < std::max(kFits * rest.points, kMuch * without);
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

}  // namespace glidelab::diagnose
