#include "diagnose/gap/parameter_gap.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "diagnose/fit/projected_motion.h"
#include "diagnose/frames/missing_frames.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/tracks/thin_tracks.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFewestOneWay = 12;   // of a stretch that goes one way
constexpr double kOpenMu = 0.1;             // sd of a friction that is not known
constexpr double kOpenK = 10.0;             // likewise of a drag, over the drag of all
constexpr double kSameData = 1e-6;          // of the variance: then the part is all there is
constexpr Eigen::Index kDrag = 0, kMu = 1;  // among common parameters
using Kind = ParameterLayout::Global::Kind;

/// Motions of one mass, whole or their stretches in one direction, with a fit's point on them.
struct Part {
  TrackSet set;
  FitPoint at;
  Lateness late;
};

/// direction 0: both ways.
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
      if (to - from < kFewestOneWay) continue;
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

/// What the part alone gives more than all for a common parameter, by one step from the fit to all, and the variance.
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

  /// Of the common parameter with this index, which effects are not.
  Step of(Eigen::Index quantity) const {
    Eigen::VectorXd a = Eigen::VectorXd::Zero(covariance_.rows());
    a(fitted_) = fitted_covariance_.col(quantity);  // what is no effect comes first
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
  // Missing frames are no effect of a fit but in its times.
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
        if (var_alone - var_together < kSameData * var_together) continue;  // it is all there is
        GapOfParameter gap;
        gap.quantity = quantity == kDrag ? "k_n_s_m" : "mu";
        gap.against = "all clips";
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
