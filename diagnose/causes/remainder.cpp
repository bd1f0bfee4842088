#include "diagnose/causes/remainder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "base/math/dense.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kMostParts = 24, kFewestParts = 6;
constexpr std::size_t kPointsOfPart = 4;  // at least, on average
constexpr double kUnseen = 1e-12;         // relative to the largest square
constexpr double kRounding = 1e-13;

/// The parts of a motion over which the acceleration is constant.
struct Parts {
  Eigen::MatrixXd columns;  ///< response of x to a unit acceleration in each part, in units of the noise
  Eigen::MatrixXd shapes;   ///< 1, sign(v) and (K/m) v of each part, or (c/m) v |v|
  double length_s = 0.0;
};

/// The displacement at a time t after the beginning of a unit acceleration that lasts for `length`, with the drag rate
/// k.
double response(double t, double length, double k) {
  if (t <= 0.0) return 0.0;
  // For an acceleration that never ends: x'' = 1 - k x'.
  const auto step = [k](double s) {
    const double ks = k * s;
    if (std::abs(ks) < 1e-3) return 0.5 * s * s * (1.0 - ks / 3.0 + ks * ks / 12.0);
    return (s - (1.0 - std::exp(-ks)) / k) / k;
  };
  return step(t) - (t > length ? step(t - length) : 0.0);
}

/// The drag of a motion per mass, k v + c v |v|; c counts where it takes the place of K only (fit/drag_of_air.h).
struct DragRate {
  double k_1_s = 0.0, c_1_m = 0.0;
};

DragRate drag_rate(const TrackSet& set, const MotionFit& fit, std::size_t i) {
  const TrackModel model = model_of(set, *fit.layout, fit.at, i);
  const double c = holds_drag(set, fit.effects) ? model.effects[slot_of(ids::quadratic_drag)] : 0.0;
  return {model.k_n_s_m / model.mass_kg, c / model.mass_kg};
}

Parts parts_of(const TrackSet& set, const MotionFit& fit, std::size_t i) {
  const TrackedMotion& data = set.motions[i];
  const std::size_t n = data.t_s.size();
  const std::size_t parts = std::clamp(n / kPointsOfPart, kFewestParts, kMostParts);
  const double from = data.t_s.front(), length = (data.t_s.back() - from) / static_cast<double>(parts);
  const DragRate drag = drag_rate(set, fit, i);
  Parts result;
  result.length_s = length;
  Eigen::MatrixXd over_sd = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(parts));
  result.shapes = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(parts), 3);
  const std::vector<double>& v = fit.motions[i].v_m_s;
  double mean_speed = 0.0;
  for (const double one : v) mean_speed += std::abs(one) / static_cast<double>(n);
  // A small change of the speed is braked at the rate k + 2 c |v|.
  const double k = std::max(0.0, drag.k_1_s + 2.0 * drag.c_1_m * mean_speed);
  std::size_t first = 0;
  for (std::size_t j = 0; j < parts; ++j) {
    const double start = from + length * static_cast<double>(j);
    double speed = 0.0, square = 0.0, sign = 0.0, count = 0.0;
    for (; first < n && (j + 1 == parts || data.t_s[first] < start + length); ++first) {
      speed += v[first];
      square += v[first] * std::abs(v[first]);
      sign += v[first] > 0.0 ? 1.0 : -1.0;
      count += 1.0;
    }
    const auto row = static_cast<Eigen::Index>(j);
    result.shapes(row, 1) = count > 0.0 ? sign / count : result.shapes(std::max<Eigen::Index>(0, row - 1), 1);
    result.shapes(row, 2) = count > 0.0 ? (std::max(0.0, drag.k_1_s) * speed + drag.c_1_m * square) / count
                                        : result.shapes(std::max<Eigen::Index>(0, row - 1), 2);
    for (std::size_t p = 0; p < n; ++p) {
      if (data.outlier[p]) continue;
      over_sd(static_cast<Eigen::Index>(p), row) = response(data.t_s[p] - start, length, k) / data.sd_of(p);
    }
  }
  TrackedMotion noise_alone = data;
  noise_alone.remainder = {};
  result.columns = whitened(noise_alone, std::move(over_sd));
  return result;
}

/// A matrix root of S: S = root root'.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& shapes, double part_s, const RemainderSizes& sizes, double wider) {
  const Eigen::Index parts = shapes.rows();
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(parts, parts + 3);
  root.leftCols(parts).diagonal().setConstant(wider * std::sqrt(sizes.q_m2_s3 / part_s));
  root.col(parts) = wider * sizes.force_m_s2 * shapes.col(0);
  root.col(parts + 1) = wider * sizes.force_m_s2 * shapes.col(1);
  root.col(parts + 2) = wider * sizes.drag * shapes.col(2);
  return root;
}

/// The price of a factor f of one motion is the tail of Student's t with four degrees of freedom, 4 log f.
constexpr double kTails = 4.0;

double price_of(const RemainderSizes& sizes) {
  double price = 0.0;
  for (const double f : sizes.wider) price += kTails * std::log(f);
  return price;
}

}  // namespace

RemainderSpace::RemainderSpace(const TrackSet& set, const MotionFit& fit, const RemainderExtra* extra) {
  common_ = fit.at.global.size();
  only_falls_ = only_falls(set);
  extra_ = extra != nullptr ? extra->columns.cols() : 0;
  extra_sd_ = extra != nullptr ? extra->sd : 0.0;
  stated_weight_ = Eigen::VectorXd::Zero(common_ + extra_);
  stated_right_ = stated_weight_;
  for (const FitStatement& s : fit.statements) {
    const auto g = static_cast<Eigen::Index>(s.global);
    const double off = s.value - fit.at.global[g], weight = 1.0 / (s.sd * s.sd);
    stated_weight_[g] += weight;
    stated_right_[g] += weight * off;
    stated_square_ += s.chi2(fit.at.global[g]);
    const ParameterLayout::Global& global = fit.layout->globals()[s.global];
    const ParameterRange& range = global.range;
    const bool has_range = std::isfinite(range.low) && std::isfinite(range.high) && range.low < range.high;
    if (s.against || global.kind == ParameterLayout::Global::Kind::effect || !has_range) continue;
    const FitStatement::Prior prior = s.prior();
    const double by_prior = 1.0 / (prior.sd * prior.sd);
    ranged_.push_back({g, fit.at.global[g], range.low, range.high, s.held.has_value(), weight, by_prior,
                       by_prior * (prior.value - fit.at.global[g])});
  }
  for (Eigen::Index e = 0; e < extra_; ++e) stated_weight_[common_ + e] = 1.0 / (extra_sd_ * extra_sd_);
  Eigen::Index row = 0;
  scale_ = stated_weight_;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const FitMotion& of = fit.motions[i];
    const Parts parts = parts_of(set, fit, i);
    Eigen::MatrixXd z(of.residual.size(), 1 + common_ + extra_ + of.own.cols());
    z.col(0) = of.residual;
    z.middleCols(1, common_) = of.global;
    if (extra_ > 0) z.middleCols(1 + common_, extra_) = extra->columns.middleRows(row, of.residual.size());
    z.rightCols(of.own.cols()) = of.own * (of.own.colwise().norm().array() + 1e-300).inverse().matrix().asDiagonal();
    row += of.residual.size();
    Motion motion;
    motion.z_z = base::transposed_product(z, z);
    motion.z_b = base::transposed_product(z, parts.columns);
    motion.b_b = base::transposed_product(parts.columns, parts.columns);
    motion.part_s = parts.length_s;
    motion.shapes = parts.shapes;
    motion.own = of.own.cols();
    motion.clip = set.motions[i].clip;
    scale_ += motion.z_z.diagonal().segment(1, common_ + extra_);
    part_s_ += parts.length_s / static_cast<double>(set.motions.size());
    motions_.push_back(std::move(motion));
  }
  scale_ = (scale_.array() + 1e-30).sqrt().inverse();
}

RemainderSpace::Sums RemainderSpace::sums_of(std::size_t i, const RemainderSizes& sizes, double wider) const {
  const Motion& motion = motions_[i];
  Sums sums;
  const Eigen::MatrixXd root = root_of(motion.shapes, motion.part_s, sizes, wider);
  const Eigen::MatrixXd b_root = base::product(motion.b_b, root), z_root = base::product(motion.z_b, root);
  Eigen::MatrixXd inner = base::transposed_product(root, b_root);
  // Where the noise is far smaller than the remainder, rounding must not make the matrix indefinite.
  inner.diagonal().array() += 1.0 + kRounding * inner.diagonal().maxCoeff();
  const Eigen::MatrixXd lower = base::cholesky_lower(inner);
  sums.log_determinant += 2.0 * lower.diagonal().array().log().sum();
  const Eigen::MatrixXd half = base::solve_lower(lower, z_root.transpose());
  const Eigen::MatrixXd z = motion.z_z - base::transposed_product(half, half);  // Z' V^-1 Z
  const Eigen::Index many = 1 + common_ + extra_;
  Eigen::MatrixXd own = z.bottomRightCorner(motion.own, motion.own);
  for (Eigen::Index o = 0; o < motion.own; ++o) {
    // A parameter that does not act on this motion (a push before it begins) neither costs nor gains anything.
    const Eigen::Index at = motion.z_z.rows() - motion.own + o;
    own(o, o) += motion.z_z(at, at) > 0.0 ? kUnseen : 1.0;
  }
  const Eigen::MatrixXd own_lower = base::cholesky_lower(own);
  sums.log_determinant += 2.0 * own_lower.diagonal().array().log().sum();
  const Eigen::MatrixXd own_half = base::solve_lower(own_lower, z.bottomLeftCorner(motion.own, many));
  const Eigen::MatrixXd rest = z.topLeftCorner(many, many) - base::transposed_product(own_half, own_half);
  sums.square = rest(0, 0);
  sums.right = rest.col(0).tail(many - 1);
  sums.normal = rest.bottomRightCorner(many - 1, many - 1);
  return sums;
}

RemainderSpace::Sums RemainderSpace::stated() const {
  Sums sums;
  sums.square = stated_square_;
  sums.right = stated_right_;
  sums.normal = Eigen::MatrixXd(stated_weight_.asDiagonal());
  return sums;
}

RemainderSpace::Sums RemainderSpace::sums_of(const RemainderSizes& sizes) const {
  Sums sums = stated();
  for (std::size_t i = 0; i < motions_.size(); ++i) sums.add(sums_of(i, sizes, sizes.of(i)), 1.0);
  return sums;
}

namespace {

/// Log of the upper tail of the standard normal distribution above z.
double log_tail(double z) {
  constexpr double kFar = 8.0;
  if (z < kFar) return std::log(0.5 * std::erfc(z / std::numbers::sqrt2));
  // The asymptotic series; its next term is 15/z⁶, 6e-5 at z = 8.
  const double by = 1.0 / (z * z);
  return -0.5 * z * z - std::log(z) - 0.5 * std::log(2.0 * std::numbers::pi) + std::log1p(-by * (1.0 - 3.0 * by));
}

/// Log of the normal probability between two limits.
double log_between(double low, double high, double mean, double sd) {
  const bool below = low + high < 2.0 * mean;  // the mirror image has the limits above the mean
  const double near = (below ? mean - high : low - mean) / sd, far = (below ? mean - low : high - mean) / sd;
  const double upper = log_tail(near);
  return upper + std::log1p(-std::exp(log_tail(far) - upper));
}

}  // namespace

/// What the ranges of stated parameters add to the log likelihood. A prior ends at its range, and has an integral of 1
/// over it. A parameter p within its range has the probability of the range under its Gaussian. One that is held at an
/// edge p_0 counts as known there so far; in place of that it has the integral over its range of
///
///     exp(s (p - p_0) - h (p - p_0)²/2),
///
/// with the score s and the curvature h there, for the best values of the others.
double RemainderSpace::log_within_ranges(const Eigen::MatrixXd& lower, const Eigen::VectorXd& along) const {
  double log = 0.0;
  for (const Ranged& of : ranged_) {
    log -= log_between(of.low, of.high, of.at + of.prior_right / of.prior_weight, 1.0 / std::sqrt(of.prior_weight));
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(lower.rows());
    unit[of.global] = scale_[of.global];
    const Eigen::VectorXd column = base::solve_lower(lower, unit);
    const double variance = column.squaredNorm(), change = column.dot(along);
    if (!of.held) {
      log += log_between(of.low, of.high, of.at + change, std::sqrt(variance));
      continue;
    }
    const double score = change / variance + of.prior_right;
    const double curvature = std::max(0.0, 1.0 / variance - of.held_weight) + of.prior_weight;
    log -= 0.5 * change * change / variance + 0.5 * std::log(variance);
    log += 0.5 * score * score / curvature - 0.5 * std::log(curvature);
    log += log_between(of.low, of.high, of.at + score / curvature, 1.0 / std::sqrt(curvature));
  }
  return log;
}

double RemainderSpace::log_likelihood(const Sums& sums) const {
  // Scaled, and with a floor for directions of which the data say nothing: such a direction costs every explanation the
  // same.
  Eigen::MatrixXd scaled = scale_.asDiagonal() * sums.normal * scale_.asDiagonal();
  scaled.diagonal().array() += kUnseen;
  const Eigen::MatrixXd lower = base::cholesky_lower(scaled);
  const Eigen::VectorXd along = base::solve_lower(lower, scale_.cwiseProduct(sums.right));
  double log = -0.5 * (sums.square - along.squaredNorm()) - 0.5 * sums.log_determinant;
  log -= lower.diagonal().array().log().sum() - scale_.array().log().sum();
  if (extra_ > 0) log -= static_cast<double>(extra_) * std::log(extra_sd_);
  return log + log_within_ranges(lower, along);
}

double RemainderSpace::chi2(const RemainderSizes& sizes) const {
  const Sums sums = sums_of(sizes);
  Eigen::MatrixXd scaled = scale_.asDiagonal() * sums.normal * scale_.asDiagonal();
  scaled.diagonal().array() += kUnseen;
  const Eigen::VectorXd along = base::solve_lower(base::cholesky_lower(scaled), scale_.cwiseProduct(sums.right));
  return sums.square - along.squaredNorm();
}

double RemainderSpace::log_likelihood(const RemainderSizes& sizes) const {
  return log_likelihood(sums_of(sizes)) - price_of(sizes);
}

RemainderSpace::Solution RemainderSpace::solve(const RemainderSizes& sizes) const {
  std::map<std::size_t, Sums> of_clips;
  Sums sums = stated();
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const Sums of = sums_of(i, sizes, sizes.of(i));
    sums.add(of, 1.0);
    const auto [clip, is_new] = of_clips.try_emplace(motions_[i].clip, of);
    if (!is_new) clip->second.add(of, 1.0);
  }
  Eigen::MatrixXd scaled = scale_.asDiagonal() * sums.normal * scale_.asDiagonal();
  scaled.diagonal().array() += kUnseen;
  const Eigen::MatrixXd inverse = scale_.asDiagonal() * base::inverse_positive(scaled) * scale_.asDiagonal();
  const Eigen::VectorXd change = base::product(inverse, sums.right);
  Eigen::MatrixXd scatter = Eigen::MatrixXd(stated_weight_.asDiagonal());
  const auto clips = static_cast<double>(of_clips.size());
  for (const auto& [clip, of] : of_clips) {
    const Eigen::VectorXd score = of.right - base::product(of.normal, change);
    scatter += clips / std::max(1.0, clips - 1.0) * score * score.transpose();
  }
  const Eigen::MatrixXd between = base::product(base::product(inverse, scatter), inverse);
  return {change.head(common_), inverse.topLeftCorner(common_, common_), between.topLeftCorner(common_, common_)};
}

RemainderSpace::Best RemainderSpace::likeliest(const RemainderSizes* start) const {
  // The largest force of the first search is a tenth of g. A drag that scatters too widely would be negative in
  // some motions and push, and the linear neighbourhood of a fit does not hold that far. The air brakes objects of one
  // shape more alike than magnets or bearings brake a glider.
  constexpr double kMostForce = 1.0, kMostDrag = 0.7, kMostDragOfAir = 0.2, kDecades = 6.0;
  const double most_drag = only_falls_ ? kMostDragOfAir : kMostDrag;
  Best best;
  if (start != nullptr) best.sizes = *start;
  const auto look = [&](double RemainderSizes::*member, double value) {
    RemainderSizes sizes = best.sizes;
    sizes.*member = value;
    if (sizes.drag > most_drag) return false;
    const double log = log_likelihood(sizes);
    if (log <= best.log_likelihood) return false;
    best.sizes = std::move(sizes);
    best.log_likelihood = log;
    return true;
  };
  const auto along = [&](double RemainderSizes::*member, double most, double decades, double step) {
    look(member, 0.0);
    for (double power = 0.0; power <= decades; power += step) look(member, most * std::pow(10.0, -power));
  };
  const auto refine = [&](double RemainderSizes::*member, double ratio) {
    for (int direction = 0; direction < 2; ++direction, ratio = 1.0 / ratio) {
      for (int step = 0; step < 6 && best.sizes.*member > 0.0; ++step) {
        if (!look(member, best.sizes.*member * ratio)) break;
      }
    }
  };
  // Scatter from motion to motion takes at least two motions. With one, it would absorb the law itself.
  const bool scatter = motions_.size() > 1, force_scatters = scatter && !only_falls_;
  if (!force_scatters) best.sizes.force_m_s2 = 0.0;
  best.sizes.drag = scatter ? std::min(best.sizes.drag, most_drag) : 0.0;
  best.log_likelihood = log_likelihood(best.sizes);
  const double q_most = kMostForce * kMostForce * part_s_;
  if (start == nullptr || start->q_m2_s3 == 0.0) along(&RemainderSizes::q_m2_s3, q_most, 2.0 * kDecades, 1.0);
  if (force_scatters && (start == nullptr || start->force_m_s2 == 0.0))
    along(&RemainderSizes::force_m_s2, kMostForce, kDecades, 1.0);
  if (scatter && (start == nullptr || start->drag == 0.0))
    along(&RemainderSizes::drag, most_drag, 0.5 * kDecades, 0.75);
  for (const double ratio : {3.0, 1.4}) {
    refine(&RemainderSizes::q_m2_s3, ratio * ratio);
    refine(&RemainderSizes::force_m_s2, ratio);
    refine(&RemainderSizes::drag, ratio);
  }
  // Once the worst motion has its own factor, the others need less, and the worst one stands out more: repeat.
  constexpr int kRounds = 4;
  constexpr double kSettled = 0.1;  // log likelihood
  for (int round = 0; round < kRounds; ++round) {
    const double before = best.log_likelihood;
    if (motions_.size() > 2) widen_the_worst(best);
    refine(&RemainderSizes::q_m2_s3, 1.4 * 1.4);
    refine(&RemainderSizes::force_m_s2, 1.4);
    if (best.log_likelihood < before + kSettled) break;
  }
  return best;
}

void RemainderSpace::widen_the_worst(Best& best) const {
  best.sizes.wider.resize(motions_.size(), 1.0);
  Sums sums = sums_of(best.sizes);
  double price = price_of(best.sizes);
  best.log_likelihood = log_likelihood(sums) - price;
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const double now = best.sizes.wider[i];
    Sums others = sums;
    others.add(sums_of(i, best.sizes, now), -1.0);
    for (const double f : {1.0, 2.0, 4.0, 8.0, 16.0}) {
      Sums with = others;
      with.add(sums_of(i, best.sizes, f), 1.0);
      const double log = log_likelihood(with) - price - kTails * std::log(f / now);
      if (log <= best.log_likelihood) continue;
      best.log_likelihood = log;
      best.sizes.wider[i] = f;
      sums = std::move(with);
    }
    price += kTails * std::log(best.sizes.wider[i] / now);
  }
}

void add_remainder(const MotionFit& fit, const RemainderSizes& sizes, TrackSet& set) {
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const Parts parts = parts_of(set, fit, i);
    const Eigen::MatrixXd spread =
        base::product(parts.columns, root_of(parts.shapes, parts.length_s, sizes, sizes.of(i)));
    const base::SymmetricEigen eigen = base::symmetric_eigen(base::transposed_product(spread, spread));
    Remainder remainder;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index j = 0; j < eigen.values.size(); ++j) {
      if (eigen.values[j] > 1e-3 && eigen.values[j] > kUnseen * eigen.values.tail(1)[0]) kept.push_back(j);
    }
    const auto many = static_cast<Eigen::Index>(kept.size());
    remainder.span.resize(spread.rows(), many);
    remainder.shrink.resize(many);
    for (Eigen::Index k = 0; k < many; ++k) {
      const double value = eigen.values[kept[static_cast<std::size_t>(k)]];
      const Eigen::VectorXd along = eigen.vectors.col(kept[static_cast<std::size_t>(k)]);
      remainder.span.col(k) = base::product(spread, along) / std::sqrt(value);
      remainder.shrink[k] = 1.0 - 1.0 / std::sqrt(1.0 + value);
    }
    set.motions[i].remainder = std::move(remainder);
  }
}

BesideRemainder beside_remainder(const TrackSet& set, const MotionFit& fit, const RemainderSizes& sizes) {
  BesideRemainder beside{set, {}, sizes};
  add_remainder(fit, sizes, beside.set);
  beside.fit = linearise_again(beside.set, fit);
  return beside;
}

BesideRemainder beside_own_remainder(const TrackSet& set, const MotionFit& fit) {
  BesideRemainder beside = beside_remainder(set, fit, RemainderSpace(set, fit).likeliest().sizes);
  MotionFit again = fit_motions(beside.set, fit.effects, fit.at, fit.late);
  if (std::isfinite(again.cost)) beside.fit = std::move(again);
  return beside;
}

}  // namespace glidelab::diagnose
