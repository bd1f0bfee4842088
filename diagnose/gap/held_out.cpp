#include "diagnose/gap/held_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/motion/smoothing/local_polynomial.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/tracks/tracked_motions.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kStretches = 4, kFewestStretches = 3;  // of a single clip
constexpr std::size_t kMotionsForAll = 3;  // motions of a single clip from which on each is held out: fewer may all go
                                           // in one direction
constexpr std::size_t kFewest = 8;         // points of a stretch, or to smooth
constexpr double kLeastKnown = 1e-4;       // of information, relative to a statement's or to that of all clips: below
                                           // this, what else is known of a parameter is no measure of anything

/// Adds the squares of the second derivative of the residuals, smoothed as the analysis smooths positions, of a motion
/// from point `first` on.
void add_accelerations(const TrackSet& set, std::size_t i, const Eigen::VectorXd& over_sd, std::size_t first,
                       ClipGap& clip) {
  const TrackedMotion& data = set.motions[i];
  const double bandwidth = set.clips[data.clip].bandwidth_s;
  if (!(bandwidth > 0.0)) return;
  std::vector<double> t, r;
  for (Eigen::Index k = 0; k < over_sd.size(); ++k) {
    const std::size_t p = first + static_cast<std::size_t>(k);
    if (data.outlier[p]) continue;
    t.push_back(data.t_s[p]);
    r.push_back(over_sd[k] * data.sd_of(p));
  }
  if (t.size() < kFewest) return;
  const core::LocalCubic cubic(t, bandwidth);
  for (std::size_t p = 0; p < t.size(); p += 3) {
    if (t[p] - t.front() < 2.0 * bandwidth || t.back() - t[p] < 2.0 * bandwidth) continue;
    const auto row = cubic.row_of_point(p);
    if (!row) continue;
    const double a = core::weighted_sums(*row, r).a_m_s2;
    clip.acceleration_square += a * a;
    clip.acceleration_count += 1.0;
  }
}

HeldOutGap gap_over(std::vector<ClipGap> clips) {
  HeldOutGap gap;
  double chi2 = 0.0, freedom = 0.0, a_sum = 0.0, a_count = 0.0;
  for (const ClipGap& clip : clips) {
    chi2 += clip.chi2;
    freedom += clip.freedom;
    a_sum += clip.acceleration_square;
    a_count += clip.acceleration_count;
  }
  gap.clips = std::move(clips);
  if (freedom <= 0.0) return gap;
  gap.value = std::sqrt(std::max(0.0, chi2) / freedom);
  // Relative variances: 0.5/n for the root mean square of n residuals, and 1.32/n for the estimated noise that it is
  // compared with. Both come from the same positions; as the first is the smallest variance possible, it is also their
  // covariance: 0.5 + 1.32 - 2 * 0.5.
  gap.standard_error = std::sqrt(0.82 / freedom);
  if (a_count > 0.0) gap.acceleration_m_s2 = std::sqrt(a_sum / a_count);
  return gap;
}

/// The number of stretches in which a motion of this many points is held out. The only motion is held out in three at
/// least, so that the others tell its parameters.
std::size_t stretches_of(std::size_t points, bool only) {
  return std::clamp<std::size_t>(points / kFewest, only ? kFewestStretches : 1, kStretches);
}

/// The part of a step that the others can be asked for: a parameter of which they know next to nothing, compared with
/// all, stays where all have it. They would predict any acceleration with a bumper that only this clip reaches.
Eigen::VectorXd known_step(const CommonNormal& others, const Eigen::VectorXd& information_of_all) {
  std::vector<Eigen::Index> known;
  for (Eigen::Index g = 0; g < others.right.size(); ++g) {
    if (others.matrix(g, g) > kLeastKnown * information_of_all[g]) known.push_back(g);
  }
  Eigen::VectorXd step = Eigen::VectorXd::Zero(others.right.size());
  if (known.empty()) return step;
  step(known) = base::product(inverse_normal(others.matrix(known, known)), Eigen::VectorXd(others.right(known)));
  return step;
}

/// The change of the common parameters from the fit to its linear minimum.
Eigen::VectorXd to_minimum(CommonNormal all, const std::vector<ProjectedMotion>& motions) {
  for (const ProjectedMotion& motion : motions) all.add(motion);
  return base::product(inverse_normal(all.matrix), all.right);
}

/// Adds motions that are held out together, each with a start of its own. `others` has the other motions and the
/// statements, and `shift` leads to the minimum by all. With G the derivatives with respect to the common parameters, C
/// their covariance by the others, r the residuals at the minimum by all and g the gradient G'r of the others there,
/// which is minus that of these motions, the residuals u of the prediction have
///
///     u = r - G C g,    u'(1 + G C G')^-1 u = r'r + g'C g.
///
/// What the others do not determine at all has no part in g.
void add_held_out(const TrackSet& set, const std::vector<ProjectedMotion>& motions, CommonNormal others,
                  const Eigen::VectorXd& shift, const std::vector<std::size_t>& which, ClipGap& clip) {
  others.right -= base::product(others.matrix, shift);
  Eigen::VectorXd information = others.matrix.diagonal();
  for (const std::size_t i : which) information += motions[i].common.colwise().squaredNorm().transpose();
  const Eigen::VectorXd step = known_step(others, information);
  for (const std::size_t i : which) {
    const Eigen::VectorXd r = motions[i].residual - base::product(motions[i].common, shift);
    clip.freedom += motions[i].freedom;
    clip.chi2 += r.squaredNorm();
    add_accelerations(set, i, coloured(set.motions[i], r - base::product(motions[i].common, step)), 0, clip);
  }
  const Eigen::VectorXd to_others = base::product(inverse_normal(others.matrix), others.right);
  clip.chi2 += others.right.dot(to_others);
}

/// The stretches of a single clip's motions, each predicted from all the others, with the motion's own start and speed
/// from the rest of the motion. This is add_held_out() with D in place of G, a stretch's derivatives with respect to
/// the common and the motion's own parameters, and C and g those of all but the stretch.
///
/// A motion of too few points for two stretches is held out whole: nothing else tells its start, which is fitted to it.
HeldOutGap gap_of_stretches(const TrackSet& set, const MotionFit& at) {
  const MotionFit fit = at_linear_minimum(set, at);
  const CommonNormal stated = statements_normal(fit);
  std::vector<ProjectedMotion> projected;
  for (const FitMotion& motion : fit.motions) projected.push_back(project(motion));
  const Eigen::VectorXd shift = to_minimum(stated, projected);
  std::vector<ClipGap> clips;
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const FitMotion& motion = fit.motions[i];
    const TrackedMotion& data = set.motions[i];
    CommonNormal others = stated;
    for (std::size_t j = 0; j < projected.size(); ++j) {
      if (j != i) others.add(projected[j]);
    }
    const std::size_t points = data.t_s.size(), stretches = stretches_of(points, fit.motions.size() == 1);
    const auto named = [&](std::size_t from, std::size_t to) {
      return ClipGap{
          fmt::format("{}, {:.2f} to {:.2f} s", set.clips[data.clip].name, data.t_s[from], data.t_s[to - 1])};
    };
    if (stretches == 1) {
      ClipGap clip = named(0, points);
      add_held_out(set, projected, others, shift, {i}, clip);
      if (clip.freedom > 0.0) clips.push_back(std::move(clip));
      continue;
    }
    const Eigen::Index common = motion.global.cols(), own = motion.own.cols();
    Eigen::MatrixXd columns(motion.global.rows(), common + own);
    columns << motion.global, motion.own;
    for (std::size_t k = 0; k < stretches; ++k) {
      const std::size_t from = points * k / stretches, to = points * (k + 1) / stretches;
      ClipGap clip = named(from, to);
      for (std::size_t p = from; p < to; ++p) clip.freedom += data.outlier[p] ? 0.0 : 1.0;
      if (clip.freedom <= 0.0) continue;
      const auto row = static_cast<Eigen::Index>(from), rows = static_cast<Eigen::Index>(to - from);
      const Eigen::Index after = columns.rows() - row - rows;
      Eigen::MatrixXd rest(columns.rows() - rows, common + own);
      Eigen::VectorXd of_rest(rest.rows());
      rest << columns.topRows(row), columns.bottomRows(after);
      of_rest << motion.residual.head(row), motion.residual.tail(after);
      CommonNormal all_but{base::transposed_product(rest, rest), base::transposed_product(rest, of_rest)};
      all_but.matrix.topLeftCorner(common, common) += others.matrix;
      all_but.right.head(common) += others.right;
      const Eigen::VectorXd r = motion.residual.segment(row, rows);
      const Eigen::MatrixXd d = columns.middleRows(row, rows);
      const Eigen::VectorXd information = all_but.matrix.diagonal() + d.colwise().squaredNorm().transpose();
      const Eigen::VectorXd to_rest = base::product(inverse_normal(all_but.matrix), all_but.right);
      clip.chi2 = r.squaredNorm() + all_but.right.dot(to_rest);
      Eigen::VectorXd whole = Eigen::VectorXd::Zero(motion.residual.size());
      whole.segment(row, rows) = r - base::product(d, known_step(all_but, information));
      add_accelerations(set, i, coloured(data, std::move(whole)).segment(row, rows), from, clip);
      clips.push_back(std::move(clip));
    }
  }
  return gap_over(std::move(clips));
}

/// Every motion of a single clip as a separate clip.
TrackSet motions_apart(const TrackSet& set) {
  TrackSet apart = set;
  apart.clips.clear();
  for (std::size_t i = 0; i < apart.motions.size(); ++i) {
    TrackedMotion& motion = apart.motions[i];
    apart.clips.push_back(set.clips.front());
    apart.clips.back().name += fmt::format(", {:.2f} to {:.2f} s", motion.t_s.front(), motion.t_s.back());
    motion.clip = i;
  }
  return apart;
}

}  // namespace

HeldOutGap held_out_gap(const TrackSet& set, const MotionFit& fit) {
  if (set.clips.size() == 1) {
    return set.motions.size() < kMotionsForAll ? gap_of_stretches(set, fit) : held_out_gap(motions_apart(set), fit);
  }
  std::vector<ProjectedMotion> motions;
  for (const FitMotion& motion : fit.motions) motions.push_back(project(motion));
  const CommonNormal stated = statements_normal(fit);
  const Eigen::VectorXd shift = to_minimum(stated, motions);
  const std::vector<CommonNormal> others = without_each_clip(set, stated, motions);
  std::vector<ClipGap> clips;
  for (std::size_t c = 0; c < set.clips.size(); ++c) {
    ClipGap clip{set.clips[c].name};
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (set.motions[i].clip == c) own.push_back(i);
    }
    add_held_out(set, motions, others[c], shift, own, clip);
    if (clip.freedom <= 0.0) continue;  // nothing in it moves
    clips.push_back(std::move(clip));
  }
  return gap_over(std::move(clips));
}

TrackSet split_clip(const TrackSet& set) {
  TrackSet split = set;
  split.clips.clear();
  split.motions.clear();
  for (const TrackedMotion& motion : set.motions) {
    const std::size_t n = motion.t_s.size();
    for (std::size_t k = 0; k < kStretches; ++k) {
      const std::size_t from = n * k / kStretches, to = n * (k + 1) / kStretches;
      TrackedMotion part = some_points(motion, from, to);
      if (part.t_s.size() < kFewest) continue;
      if (set.position_noise) whiten(part, set.position_noise->shape, set.clips[motion.clip].frame_rate_hz);
      part.clip = split.clips.size();
      TrackedClip clip = set.clips[motion.clip];
      clip.name = fmt::format("{}, {:.2f} to {:.2f} s", clip.name, part.t_s.front(), part.t_s.back());
      split.clips.push_back(clip);
      split.motions.push_back(std::move(part));
    }
  }
  return split;
}

Eigen::MatrixXd common_covariance(const MotionFit& fit) {
  CommonNormal all = statements_normal(fit);
  for (const FitMotion& motion : fit.motions) all.add(project(motion));
  return inverse_normal(all.matrix);
}

MotionFit at_linear_minimum(const TrackSet& set, MotionFit fit) {
  CommonNormal all = statements_normal(fit);
  for (const FitMotion& motion : fit.motions) all.add(project(motion));
  const Eigen::VectorXd shift = base::product(inverse_normal(all.matrix), all.right);
  fit.at.global += shift;
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    FitMotion& motion = fit.motions[i];
    motion.residual -= base::product(motion.global, shift);
    const auto [scale, own, gain] = own_columns(motion);
    const Eigen::VectorXd own_shift = base::product(gain, motion.residual);
    fit.at.own[i] += scale.cwiseProduct(own_shift);
    motion.residual -= base::product(own, own_shift);
    motion.plain = coloured(set.motions[i], motion.residual);
  }
  return fit;
}

std::vector<StatementPull> statement_pulls(const TrackSet& set, const MotionFit& fit) {
  const Eigen::MatrixXd covariance = common_covariance(fit);
  std::vector<StatementPull> pulls;
  for (const FitStatement& s : fit.statements) {
    if (!s.against) continue;
    const auto g = static_cast<Eigen::Index>(s.global);
    // Residual of a datum that took part in the fit: its variance is sd² minus that of the fitted value.
    const double variance = s.sd * s.sd - covariance(g, g), off = s.value - fit.at.global[g];
    StatementPull pull{"alpha_deg", *s.against, set.groups[fit.layout->globals()[s.global].index].name, {}};
    pull.stated_rad = s.value;
    pull.stated_sd_rad = s.sd;
    if (variance > kLeastKnown * s.sd * s.sd) {
      pull.z = off / std::sqrt(variance);
      pull.else_rad = s.value - off * s.sd * s.sd / variance;
      pull.else_sd_rad = s.sd * std::sqrt(covariance(g, g) / variance);
    }
    pulls.push_back(std::move(pull));
  }
  return pulls;
}

}  // namespace glidelab::diagnose
