#include "diagnose/next/expected_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/math/dense.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/next/next_changes.h"

namespace glidelab::diagnose {
namespace {

using Global = ParameterLayout::Global;

/// New data of an explanation: residuals, and derivatives with respect to the common parameters (own ones projected
/// out).
struct Rows {
  Eigen::MatrixXd global;
  Eigen::VectorXd residual;
};

/// The derivatives with respect to what the clip would have of its own (Each::clip), times the spread of the clips so
/// far; no columns if there is nothing of the kind.
Eigen::MatrixXd own_deviations(const TrackSet& one, const MotionFit& b, const ParameterLayout& layout, FitPoint at) {
  const auto& globals = layout.globals();
  std::vector<Eigen::Index> of_clip;  // the parameters of one clip so far, and their spread over all
  std::vector<double> spread;
  std::size_t clip = 0;
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].parameter == nullptr || globals[g].parameter->each != Each::clip) continue;
    if (of_clip.empty()) clip = globals[g].index;
    if (globals[g].index != clip) continue;
    double squares = 0.0, clips = 0.0;
    for (std::size_t other = 0; other < b.layout->globals().size(); ++other) {
      if (b.layout->globals()[other].parameter != globals[g].parameter) continue;
      squares += std::pow(b.at.global[static_cast<Eigen::Index>(other)], 2);
      clips += 1.0;
    }
    of_clip.push_back(static_cast<Eigen::Index>(g));
    spread.push_back(std::sqrt(squares / clips));
    at.global[of_clip.back()] = 0.0;
  }
  if (of_clip.empty()) return {};
  TrackSet as_known = one;  // in place of that clip, so that its parameters act on this motion
  as_known.clips[clip] = one.clips.back();
  as_known.motions.front().clip = clip;
  const FitMotion moved = linearise(as_known, layout, at, 0, {}, Derivatives::central);
  Eigen::MatrixXd columns(moved.global.rows(), std::ssize(of_clip));
  for (std::size_t k = 0; k < of_clip.size(); ++k) {
    columns.col(static_cast<Eigen::Index>(k)) = spread[k] * moved.global.col(of_clip[k]);
  }
  return columns.allFinite() ? columns : Eigen::MatrixXd();
}

/// Rows with noise of covariance 1 + Z Z' as rows with white noise: with Z = U S V', times 1 - U (1 - 1/sqrt(1 + S²))
/// U'.
void whiten(const Eigen::MatrixXd& z, Rows& rows) {
  if (z.cols() == 0) return;
  const base::SymmetricEigen eigen = base::symmetric_eigen(Eigen::MatrixXd(base::transposed_product(z, z)));
  for (Eigen::Index k = 0; k < z.cols(); ++k) {
    const double square = eigen.values[k];
    if (!(square > 1e-12)) continue;
    const Eigen::VectorXd u = z * eigen.vectors.col(k) / std::sqrt(square);
    const double less = 1.0 - 1.0 / std::sqrt(1.0 + square);
    const Eigen::RowVectorXd seen = u.transpose() * rows.global;
    rows.residual -= less * u.dot(rows.residual) * u;
    rows.global -= less * u * seen;
  }
}

Rows clip_rows(const TrackSet& set, const MotionFit& a, const MotionFit& b, const Change& change) {
  const auto [one, moved] = next_motion(set, a, change);
  if (moved.x_m.empty()) return {};
  const ParameterLayout layout(one, b.effects, *b.layout);
  const FitMotion by = linearise(one, layout, next_point(set, b, change), 0, {}, Derivatives::central);
  if (!by.residual.allFinite() || !by.global.allFinite() || !by.own.allFinite()) return {};
  const Eigen::VectorXd scale = (by.own.colwise().squaredNorm().transpose().array() + 1e-300).sqrt().inverse();
  const Eigen::MatrixXd own = by.own * scale.asDiagonal();
  Eigen::MatrixXd normal = base::transposed_product(own, own);
  normal.diagonal().array() += 1e-12;
  const Eigen::MatrixXd gain = base::solve_positive(normal, own.transpose());
  const auto without_own = [&](const Eigen::MatrixXd& of) {
    return Eigen::MatrixXd(of - base::product(own, base::product(gain, of)));
  };
  Rows rows{without_own(by.global), by.residual - base::product(own, base::product(gain, by.residual))};
  const Eigen::MatrixXd deviations = own_deviations(one, b, layout, next_point(set, b, change));
  if (deviations.cols() > 0) whiten(without_own(deviations), rows);
  return rows;
}

/// The value of a stated quantity, from a fit's parameters.
double stated_by(const TrackSet& set, const MotionFit& fit, const FitPoint& at, const NextStatement& statement) {
  if (statement.of == NextStatement::Of::inclination) {
    return at.global[static_cast<Eigen::Index>(2 + statement.group)];
  }
  TrackModel model = model_of(set, *fit.layout, at, 0);
  if (statement.of == NextStatement::Of::clock) return model.effects[slot_of(ids::frame_rate_error)];
  model.effects[slot_of(ids::camera_motion)] = 0.0;
  model.row_px = {};
  model.v0_m_s = 0.0;
  const std::array<double, 1> now = {0.0};
  const auto seen = [&](double x_m) {
    model.x0_m = x_m;
    return move(model, now).x_m.front();
  };
  double length = seen(statement.to_m) - seen(statement.from_m);
  double scale_sd = 0.0, c = 0.0;  // of the plane in which it is measured
  for (const TrackedMotion& motion : set.motions) scale_sd = std::max(scale_sd, motion.scale_sd);
  for (std::size_t g = 0; g < fit.layout->globals().size(); ++g) {
    if (fit.layout->globals()[g].kind == Global::Kind::scale) c = at.global[static_cast<Eigen::Index>(g)];
  }
  length *= 1.0 + c * scale_sd;
  return length;
}

Rows statement_rows(const TrackSet& set, const MotionFit& a, const MotionFit& b,
                    const std::vector<NextStatement>& statements) {
  const auto n = static_cast<Eigen::Index>(statements.size());
  Rows rows{Eigen::MatrixXd::Zero(n, b.at.global.size()), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index s = 0; s < n; ++s) {
    const NextStatement& statement = statements[static_cast<std::size_t>(s)];
    rows.residual[s] = (stated_by(set, a, a.at, statement) - stated_by(set, b, b.at, statement)) / statement.sd;
    FitPoint near = b.at;
    for (Eigen::Index g = 0; g < near.global.size(); ++g) {
      const double kept = near.global[g], step = 1e-6;
      near.global[g] = kept + step;
      const double above = stated_by(set, b, near, statement);
      near.global[g] = kept - step;
      const double below = stated_by(set, b, near, statement);
      near.global[g] = kept;
      rows.global(s, g) = (above - below) / (2.0 * step * statement.sd);
    }
  }
  return rows;
}

/// The covariance with a new set-up's inclination inserted at its index.
Eigen::MatrixXd with_set_up(const TrackSet& set, const Eigen::MatrixXd& covariance, const NextSetUp& set_up) {
  const Eigen::Index n = covariance.rows(), at = new_alpha(set);
  Eigen::MatrixXd wider = Eigen::MatrixXd::Zero(n + 1, n + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) wider(i + (i >= at), j + (j >= at)) = covariance(i, j);
  }
  const double open = 1.0 / (kOpenInclination_rad * kOpenInclination_rad);
  wider(at, at) = 1.0 / (open + (set_up.sd_rad > 0.0 ? 1.0 / (set_up.sd_rad * set_up.sd_rad) : 0.0));
  return wider;
}

/// C = L L' before the change, the new data, and 1 + L' G' G L.
struct Outlook {
  Eigen::MatrixXd root, seen, inner;
  Eigen::VectorXd residual;
};

Outlook outlook(const TrackSet& set, const MotionFit& a, const MotionFit& b, const Eigen::MatrixXd& covariance,
                const Change& change) {
  Outlook view;
  Rows rows = change.clip ? clip_rows(set, a, b, change) : statement_rows(set, a, b, change.statements);
  // Scaled, because positions in metres stand beside drags in kg/m.
  const Eigen::MatrixXd before = change.set_up ? with_set_up(set, covariance, *change.set_up) : covariance;
  const Eigen::VectorXd scale = (before.diagonal().array().max(0.0) + 1e-300).sqrt();
  const Eigen::VectorXd by = scale.cwiseInverse();
  const base::SymmetricEigen eigen = base::symmetric_eigen(Eigen::MatrixXd(by.asDiagonal() * before * by.asDiagonal()));
  const Eigen::VectorXd root = eigen.values.cwiseMax(0.0).cwiseSqrt();
  view.root = scale.asDiagonal() * eigen.vectors * root.asDiagonal();
  if (rows.residual.size() == 0) {
    rows.global = Eigen::MatrixXd::Zero(1, before.rows());
    rows.residual = Eigen::VectorXd::Zero(1);
  }
  view.seen = base::product(rows.global, view.root);
  view.inner = base::transposed_product(view.seen, view.seen);
  view.inner.diagonal().array() += 1.0;
  view.residual = std::move(rows.residual);
  return view;
}

}  // namespace

double expected_split(const TrackSet& set, const MotionFit& a, const MotionFit& b, const Eigen::MatrixXd& covariance_b,
                      const Change& change) {
  const Outlook view = outlook(set, a, b, covariance_b, change);
  const Eigen::VectorXd along = base::transposed_product(view.seen, view.residual);
  const Eigen::VectorXd taken = base::solve_positive(view.inner, along);
  return std::max(0.0, 0.5 * (view.residual.squaredNorm() - along.dot(taken)));
}

Eigen::MatrixXd expected_covariance(const TrackSet& set, const MotionFit& fit, const Eigen::MatrixXd& covariance,
                                    const Change& change) {
  const Outlook view = outlook(set, fit, fit, covariance, change);
  const Eigen::MatrixXd after =
      base::product(view.root, base::solve_positive(view.inner, Eigen::MatrixXd(view.root.transpose())));
  if (!change.set_up) return after;
  const Eigen::Index n = covariance.rows(), at = new_alpha(set);
  Eigen::MatrixXd kept(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) kept(i, j) = after(i + (i >= at), j + (j >= at));
  }
  return kept;
}

}  // namespace glidelab::diagnose
