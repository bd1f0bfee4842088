#include "diagnose/gap/domain_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "core/motion/smoothing/local_polynomial.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/single_frames/missing_frames.h"
#include "diagnose/tracks/tracked_motions.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr int kBins = 12;
constexpr double kFewestInBin = 5.0;  // points
constexpr std::size_t kFewestToSmooth = 8;
constexpr double kLeftOutAtEachEnd = 2.0;  // bandwidths that are left out at a motion's ends

/// A point of the phase plane: its speed, and d as weights of the motion's positions from `first` on.
struct PhasePoint {
  double v_m_s = 0.0;
  std::size_t first = 0;
  std::vector<double> weights;
};

/// The points of a motion that are not set aside; `used` are their indices among all.
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
    if (t[p] - t.front() < kLeftOutAtEachEnd * bandwidth_s || t.back() - t[p] < kLeftOutAtEachEnd * bandwidth_s)
      continue;
    const auto row = cubic.row_of_point(p);
    if (!row) continue;
    PhasePoint point{core::weighted_sums(*row, x).v_m_s, row->first, row->weights->a};
    for (std::size_t w = 0; w < point.weights.size(); ++w) point.weights[w] += k_over_m * row->weights->v[w];
    motion.points.push_back(std::move(point));
  }
  return motion;
}

/// Bins of speed, with an edge at 0.
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

/// Sums over each bin of speeds: of points, of v, and of d as weights of unit white noise.
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
  std::vector<Eigen::MatrixXd> covariance;  ///< of the common parameters, from all clips but this
  std::vector<Eigen::VectorXd> shift;       ///< their values, less those of the fit to all clips
};

HeldOutFit held_out(const TrackSet& set, const MotionFit& fit) {
  HeldOutFit out;
  for (const FitMotion& motion : fit.motions) out.motions.push_back(project(motion));
  for (const CommonNormal& others : without_each_clip(set, statements_normal(fit), out.motions)) {
    out.covariance.push_back(inverse_normal(others.matrix));
    out.shift.push_back(base::product(out.covariance.back(), others.right));
  }
  return out;
}

/// d of each bin of speeds, summed over the motions of a mass (or all), from the held-out residuals, with its standard
/// deviation from their noise:
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

namespace {

constexpr std::size_t kFewestInDirection = 12;  // points of a stretch in one direction
constexpr double kOpenMu = 0.1;                 // sd of an undetermined friction
constexpr double kOpenK = 10.0;                 // the same for drag, relative to the drag of all
constexpr double kSameData = 1e-6;              // relative to the variance: below this the part is all there is
constexpr Eigen::Index kDrag = 0, kMu = 1;      // among common parameters
using Kind = ParameterLayout::Global::Kind;

/// The motions of one mass, whole or only the stretches in one direction, with the parameters of a fit to them.
struct Part {
  TrackSet set;
  FitPoint at;
  Lateness late;
};

/// direction 0: both directions.
Part part_of(const TrackSet& set, const MotionFit& fit, std::size_t mass, int direction) {
  Part part{set, {fit.at.global, {}}, {}};
  part.set.motions.clear();
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    if (motion.mass != mass) continue;
    if (direction == 0) {
      part.set.motions.push_back(motion);
      part.at.own.push_back(fit.at.own[i]);
      if (!fit.late.empty()) part.late.push_back(fit.late[i]);
      continue;
    }
    if (!motion.known.t_s.empty()) continue;
    const std::vector<double>& v = fit.motions[i].v_m_s;
    const std::vector<double> x = move(model_of(set, *fit.layout, fit.at, i), motion.t_s,
                                       fit.late.empty() ? std::span<const double>() : std::span(fit.late[i]))
                                      .x_m;
    for (std::size_t from = 0, to; from < v.size(); from = to) {
      to = from + 1;
      if (!(v[from] * direction > 0.0)) continue;
      while (to < v.size() && v[to] * direction > 0.0) ++to;
      if (to - from < kFewestInDirection) continue;
      TrackedMotion stretch = some_points(motion, from, to);
      if (set.position_noise) whiten(stretch, set.position_noise->shape, set.clips[motion.clip].frame_rate_hz);
      part.set.motions.push_back(std::move(stretch));
      Eigen::VectorXd own = fit.at.own[i];
      own[0] = x[from];
      own[1] = v[from];
      part.at.own.push_back(own);
      if (!fit.late.empty()) {
        const auto at = fit.late[i].begin();
        part.late.emplace_back(at + static_cast<std::ptrdiff_t>(from), at + static_cast<std::ptrdiff_t>(to));
      }
    }
  }
  return part;
}

/// The value of a common parameter from the part alone, less that from all, by one step from the fit to all; and its
/// variance.
struct Step {
  double change = 0.0;
  double variance = 0.0;
};

class AloneStep {
 public:
  AloneStep(const MotionFit& all, const Part& part) : normal_(statements_normal(all)) {
    const auto& globals = all.layout->globals();
    for (std::size_t g = 0; g < globals.size(); ++g) {
      (globals[g].kind == Kind::effect ? held_ : fitted_).push_back(static_cast<Eigen::Index>(g));
    }
    CommonNormal whole = normal_;
    for (const FitMotion& motion : all.motions) whole.add(project(motion));
    covariance_ = inverse_normal(whole.matrix);
    for (std::size_t i = 0; i < part.set.motions.size(); ++i) {
      normal_.add(project(linearise(part.set, *all.layout, part.at, i, part.late, Derivatives::central)));
    }
    fitted_covariance_ = inverse_normal(normal_.matrix(fitted_, fitted_));
  }

  /// For the common parameter with this index, which must not be that of an effect.
  Step of(Eigen::Index quantity) const {
    Eigen::VectorXd a = Eigen::VectorXd::Zero(covariance_.rows());
    a(fitted_) = fitted_covariance_.col(quantity);  // parameters that belong to no effect come first
    const Eigen::VectorXd na = base::product(normal_.matrix, a);
    Eigen::VectorXd b = Eigen::VectorXd::Unit(covariance_.rows(), quantity);
    b(held_) += na(held_);
    const Eigen::VectorXd cb = base::product(covariance_, b);
    return {a.dot(normal_.right), a.dot(na) - 2.0 * na.dot(cb) + b.dot(cb)};
  }
  double variance_alone(Eigen::Index quantity) const { return fitted_covariance_(quantity, quantity); }

 private:
  std::vector<Eigen::Index> fitted_, held_;
  CommonNormal normal_;  ///< of the part
  Eigen::MatrixXd covariance_, fitted_covariance_;
};

bool is_open(Eigen::Index quantity, double sd, double of_all) {
  return !(quantity == kMu ? sd < kOpenMu : sd < kOpenK * std::abs(of_all));
}

}  // namespace

std::vector<GapOfParameter> parameter_gaps(const TrackSet& set, const MotionFit& nominal, const MotionFit* after) {
  std::vector<GapOfParameter> of_drag, of_mu;
  const Eigen::MatrixXd of_all = common_covariance(nominal);
  // Missing frames are not among a fit's effects, only in its times.
  const bool same = after != nullptr && after->effects.empty() && missing_in(set, *after) == 0;
  for (std::size_t mass = 0; mass < set.masses.size(); ++mass) {
    for (const int direction : {0, 1, -1}) {
      if (direction == 0 && set.masses.size() < 2) continue;
      const Part part = part_of(set, nominal, mass, direction);
      if (part.set.motions.empty()) continue;
      const AloneStep step(nominal, part);
      const MotionFit alone = fit_motions(part.set, {}, part.at, part.late);
      std::optional<AloneStep> with;
      if (after != nullptr && !same) with.emplace(*after, part_of(set, *after, mass, direction));
      for (const Eigen::Index quantity : {kDrag, kMu}) {
        if (direction != 0 && quantity == kDrag) continue;
        const double together = nominal.at.global[quantity], var_together = of_all(quantity, quantity);
        const double var_alone = step.variance_alone(quantity);
        if (var_alone - var_together < kSameData * var_together) continue;  // the part is all there is
        GapOfParameter gap;
        gap.quantity = quantity == kDrag ? "k_n_s_m" : "mu";
        gap.against = Against::all_clips;
        gap.group = fmt::format("{:g} kg{}", set.masses[mass].mass_kg,
                                direction == 0  ? ""
                                : direction > 0 ? ", downhill"
                                                : ", uphill");
        gap.together = DiagnosedParameter{gap.quantity, together, std::sqrt(var_together)};
        if (alone.converged && !is_open(quantity, std::sqrt(var_alone), together)) {
          const double value = alone.at.global[quantity];
          gap.alone = DiagnosedParameter{gap.quantity, value, std::sqrt(var_alone)};
          gap.z_before = (value - together) / std::sqrt(step.of(quantity).variance);
          if (same) gap.z_after = gap.z_before;
        }
        if (with && !is_open(quantity, std::sqrt(with->variance_alone(quantity)), together)) {
          const Step by = with->of(quantity);
          if (by.variance > kSameData * var_together) gap.z_after = by.change / std::sqrt(by.variance);
        }
        (quantity == kDrag ? of_drag : of_mu).push_back(std::move(gap));
      }
    }
  }
  of_drag.insert(of_drag.end(), of_mu.begin(), of_mu.end());
  return of_drag;
}

}  // namespace glidelab::diagnose
