#include "diagnose/gap/phase_gap.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/motion/smoothing/local_cubic.h"
#include "diagnose/fit/projected_motion.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr int kBins = 12;
constexpr double kFewestInBin = 5.0;  // points
constexpr std::size_t kFewestToSmooth = 8;
constexpr double kEnds = 2.0;  // bandwidths from a motion's ends that are left out

/// A point of the phase plane: its speed, and d as weights of the motion's positions from `first` on.
struct PhasePoint {
  double v_m_s = 0.0;
  std::size_t first = 0;
  std::vector<double> weights;
};

/// Of a motion's points that are not set aside; `used` are their indices among all.
struct SmoothedMotion {
  std::vector<std::size_t> used;
  std::vector<PhasePoint> points;
};

SmoothedMotion smoothed(const TrackedMotion& data, double bandwidth_s, double k_over_m) {
  SmoothedMotion motion;
  std::vector<double> t, x;
  for (std::size_t p = 0; p < data.t_s.size(); ++p) {
    if (data.outlier[p]) continue;
    motion.used.push_back(p);
    t.push_back(data.t_s[p]);
    x.push_back(data.x_m[p]);
  }
  if (!(bandwidth_s > 0.0) || t.size() < kFewestToSmooth) return motion;
  const core::LocalCubic cubic(t, bandwidth_s);
  for (std::size_t p = 0; p < t.size(); ++p) {
    if (t[p] - t.front() < kEnds * bandwidth_s || t.back() - t[p] < kEnds * bandwidth_s) continue;
    const auto row = cubic.row_of_point(p);
    if (!row) continue;
    PhasePoint point{core::weighted_sums(*row, x).v_m_s, row->first, row->weights->a};
    for (std::size_t w = 0; w < point.weights.size(); ++w) point.weights[w] += k_over_m * row->weights->v[w];
    motion.points.push_back(std::move(point));
  }
  return motion;
}

/// Stretches of speed, an edge at 0.
struct SpeedBins {
  double width = 0.0;
  long first = 0;
  std::size_t count = 0;

  explicit SpeedBins(const std::vector<SmoothedMotion>& motions) {
    double low = 0.0, high = 0.0;
    bool any = false;
    for (const SmoothedMotion& motion : motions) {
      for (const PhasePoint& point : motion.points) {
        low = any ? std::min(low, point.v_m_s) : point.v_m_s;
        high = any ? std::max(high, point.v_m_s) : point.v_m_s;
        any = true;
      }
    }
    if (!(high > low)) return;
    width = (high - low) / kBins;
    first = static_cast<long>(std::floor(low / width));
    count = static_cast<std::size_t>(static_cast<long>(std::floor(high / width)) - first) + 1;
  }
  Eigen::Index of(double v_m_s) const { return static_cast<long>(std::floor(v_m_s / width)) - first; }
  double edge(std::size_t i) const { return width * static_cast<double>(first + static_cast<long>(i)); }
};

/// Sums over each stretch of speeds: of points, of v, and of d as weights of unit white noise.
struct BinSums {
  Eigen::VectorXd points, speed;
  Eigen::MatrixXd weights;
};

BinSums sums_of(const TrackedMotion& data, const SmoothedMotion& motion, const SpeedBins& bins) {
  const auto n = static_cast<Eigen::Index>(bins.count);
  BinSums sums{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n),
               Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(data.t_s.size()), n)};
  for (const PhasePoint& point : motion.points) {
    const Eigen::Index bin = bins.of(point.v_m_s);
    sums.points[bin] += 1.0;
    sums.speed[bin] += point.v_m_s;
    for (std::size_t w = 0; w < point.weights.size(); ++w) {
      const std::size_t at = motion.used[point.first + w];
      sums.weights(static_cast<Eigen::Index>(at), bin) += point.weights[w] * data.sd_of(at);
    }
  }
  sums.weights = weights_of_white(data, std::move(sums.weights));
  return sums;
}

/// A fit whose clips are held out one at a time.
struct HeldOutFit {
  std::vector<ProjectedMotion> motions;
  std::vector<Eigen::MatrixXd> covariance;  ///< of the common parameters from all clips but this
  std::vector<Eigen::VectorXd> shift;       ///< and what they come to, less the fit's
};

HeldOutFit held_out(const TrackSet& set, const MotionFit& fit) {
  HeldOutFit out;
  CommonNormal all = statements_normal(fit);
  for (const FitMotion& motion : fit.motions) {
    out.motions.push_back(project(motion));
    all.add(out.motions.back());
  }
  for (std::size_t c = 0; c < set.clips.size(); ++c) {
    const CommonNormal others = without_clip(set, all, out.motions, c);
    out.covariance.push_back(inverse_normal(others.matrix));
    out.shift.push_back(base::product(out.covariance.back(), others.right));
  }
  return out;
}

/// d of each stretch of speeds, summed over the motions of a mass (or all), as held-out residuals and as their noise
/// have it:
///
///     residual of clip c = Q n_c - G_c C_c (sum_others G' n + sum_statements e/sd),    C_c from the others.
std::vector<GapValue> summed(const TrackSet& set, const MotionFit& fit, const HeldOutFit& out,
                             const std::vector<BinSums>& sums, std::optional<std::size_t> mass) {
  const Eigen::Index bins = sums.front().points.size(), common = fit.at.global.size();
  const auto takes_part = [&](std::size_t i) { return !mass || set.motions[i].mass == *mass; };
  std::vector<Eigen::MatrixXd> by_clip(set.clips.size(), Eigen::MatrixXd::Zero(common, bins));
  Eigen::VectorXd value = Eigen::VectorXd::Zero(bins);
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    if (!takes_part(i)) continue;
    value += base::transposed_product(sums[i].weights, out.motions[i].residual);
    by_clip[set.motions[i].clip] += base::transposed_product(out.motions[i].common, sums[i].weights);
  }
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(common, bins);
  for (std::size_t c = 0; c < by_clip.size(); ++c) {
    value -= base::transposed_product(by_clip[c], out.shift[c]);
    by_clip[c] = base::product(out.covariance[c], by_clip[c]);
    all += by_clip[c];
  }
  Eigen::VectorXd variance = Eigen::VectorXd::Zero(bins);
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const Eigen::MatrixXd others = all - by_clip[set.motions[i].clip];
    Eigen::MatrixXd noise = -base::product(out.motions[i].common, others);
    if (takes_part(i)) noise += without_own(fit.motions[i], sums[i].weights);
    variance += noise.colwise().squaredNorm().transpose();
  }
  for (const FitStatement& s : fit.statements) {
    variance += (all.row(static_cast<Eigen::Index>(s.global)) / s.sd).array().square().matrix().transpose();
  }
  std::vector<GapValue> result;
  for (Eigen::Index b = 0; b < bins; ++b) result.push_back({value[b], std::sqrt(variance[b])});
  return result;
}

}  // namespace

std::vector<PhaseGap> phase_gaps(const TrackSet& set, const MotionFit& before, const MotionFit& after) {
  std::vector<SmoothedMotion> motions;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackModel model = model_of(set, *before.layout, before.at, i);
    motions.push_back(
        smoothed(set.motions[i], set.clips[set.motions[i].clip].bandwidth_s, model.k_n_s_m / model.mass_kg));
  }
  const SpeedBins bins(motions);
  if (bins.count == 0) return {};
  std::vector<BinSums> sums;
  for (std::size_t i = 0; i < motions.size(); ++i) sums.push_back(sums_of(set.motions[i], motions[i], bins));
  const HeldOutFit out_before = held_out(set, before), out_after = held_out(set, after);
  std::vector<std::optional<std::size_t>> masses = {std::nullopt};
  for (std::size_t m = 0; m < set.masses.size() && set.masses.size() > 1; ++m) masses.emplace_back(m);
  std::vector<PhaseGap> gaps;
  for (const std::optional<std::size_t>& mass : masses) {
    PhaseGap gap;
    if (mass) gap.mass_kg = set.masses[*mass].mass_kg;
    const std::vector<GapValue> was = summed(set, before, out_before, sums, mass),
                                is = summed(set, after, out_after, sums, mass);
    for (std::size_t b = 0; b < bins.count; ++b) {
      double points = 0.0, speed = 0.0;
      for (std::size_t i = 0; i < motions.size(); ++i) {
        if (mass && set.motions[i].mass != *mass) continue;
        points += sums[i].points[static_cast<Eigen::Index>(b)];
        speed += sums[i].speed[static_cast<Eigen::Index>(b)];
      }
      if (points < kFewestInBin) continue;
      gap.bins.push_back({bins.edge(b),
                          bins.edge(b + 1),
                          speed / points,
                          static_cast<std::size_t>(points),
                          {was[b].value / points, was[b].sd / points},
                          {is[b].value / points, is[b].sd / points}});
    }
    if (!gap.bins.empty()) gaps.push_back(std::move(gap));
  }
  return gaps;
}

}  // namespace glidelab::diagnose
