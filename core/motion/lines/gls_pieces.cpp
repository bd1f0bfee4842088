#include "core/motion/lines/gls_pieces.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/motion/lines/line_law.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {
namespace {

constexpr double kEventWindowBandwidths = 3.0;  // bandwidths on both sides of an event, used to estimate its time
constexpr double kEventMarginSds = 2.0;         // margin left out around an event, in standard deviations of its time

std::optional<EventTime> event_between(const Motion& motion, std::size_t from, std::size_t border, std::size_t to,
                                       EventKind kind, double bandwidth_s, const std::vector<double>& autocovariance) {
  const std::span t = std::span(motion.t_s).subspan(from, to - from);
  const std::span y = std::span(motion.y_m).subspan(from, to - from);
  return estimate_event(t, y, kind, motion.t_s[border], kEventWindowBandwidths * bandwidth_s, autocovariance);
}

/// The range of points of one stretch between the times.
FreePiece between(const Motion& motion, double from_s, double to_s, int direction) {
  const auto first = std::lower_bound(motion.t_s.begin(), motion.t_s.end(), from_s);
  const auto last = std::upper_bound(motion.t_s.begin(), motion.t_s.end(), to_s);
  return {static_cast<std::size_t>(first - motion.t_s.begin()),
          static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, last - first)), direction};
}

}  // namespace

std::vector<FreePiece> free_pieces(const Motion& motion, const FreeMotion& free, double bandwidth_s,
                                   const std::vector<double>& autocovariance) {
  std::vector<FreePiece> pieces;
  const std::size_t n = motion.t_s.size();
  std::optional<EventTime> turned;  // the event at which the last stretch turned into this one
  for (std::size_t s = 0; s < free.stretches.size(); ++s) {
    const FreeStretch& stretch = free.stretches[s];
    const std::size_t end = stretch.first + stretch.count;
    double from_s = motion.t_s[stretch.first], to_s = motion.t_s[end - 1];
    if (turned) {
      from_s = turned->t_s + kEventMarginSds * turned->sd_s;
    } else if (stretch.first > 0) {
      from_s += bandwidth_s;
    }
    turned.reset();
    std::optional<EventTime> event;
    if (s + 1 < free.stretches.size() && stretch.end == LeftOut::kernel_reversal &&
        free.stretches[s + 1].first == end) {
      event = event_between(motion, stretch.first, end, end + free.stretches[s + 1].count, EventKind::turns,
                            bandwidth_s, autocovariance);
      turned = event;
    } else if (end < n && free.reason[end] == LeftOut::rest) {
      std::size_t rest = end;
      while (rest < n && free.reason[rest] == LeftOut::rest) ++rest;
      event = event_between(motion, stretch.first, end, rest, EventKind::stops, bandwidth_s, autocovariance);
    }
    if (event) {
      to_s = event->t_s - kEventMarginSds * event->sd_s;
    } else if (end < n) {
      to_s -= bandwidth_s;
    }
    if (to_s > from_s) pieces.push_back(between(motion, from_s, to_s, stretch.direction));
  }
  return pieces;
}

namespace {

constexpr double kLeastPivot = 1e-9;  // smallest allowed pivot of C over its diagonal

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// The banded matrix of cov(weights of node i, weights of node j) for two kinds of weights, made symmetric.
template <typename First, typename Second>
Sparse covariance_of(const std::vector<KernelRow>& rows, const SeriesNoise& noise, First first, Second second) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto count = static_cast<int>(rows.size());
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j <= i; ++j) {
      const KernelRow &a = rows[static_cast<std::size_t>(i)], &b = rows[static_cast<std::size_t>(j)];
      if (b.first + b.weights->x.size() + noise.autocovariance.size() < a.first + 1) continue;  // out of reach
      const double one = noise_covariance(a.first, first(a), b.first, second(b), noise);
      const double other = noise_covariance(a.first, second(a), b.first, first(b), noise);
      entries.emplace_back(i, j, 0.5 * (one + other));
    }
  }
  Sparse matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

std::span<const double> of_v(const KernelRow& row) {
  return row.weights->v;
}
std::span<const double> of_a(const KernelRow& row) {
  return row.weights->a;
}

}  // namespace

LineNodes::LineNodes(const Motion& motion, const FreePiece& piece, const GlsInput& input, std::size_t count)
    : piece_(piece), t_(std::span(motion.t_s).subspan(piece.first, piece.count)), forced_(motion.forced) {
  const std::span x = std::span(motion.x_m).subspan(piece.first, piece.count);
  const std::span y = std::span(motion.y_m).subspan(piece.first, piece.count);
  const LocalCubic cubic(t_, input.bandwidth_s);
  std::vector<double> v, a;
  std::size_t last = piece.count;
  for (std::size_t node = 0; node < count; ++node) {
    const std::size_t j = (node * (piece.count - 1) + (count - 1) / 2) / (count - 1);
    if (j == last) continue;
    last = j;
    auto row = cubic.row_of_point(j);
    if (!row) continue;
    v.push_back(weighted_sums(*row, x).v_m_s);
    a.push_back(weighted_sums(*row, y).a_m_s2);
    force_part_.push_back(weighted_sums(*row, x).a_m_s2 - a.back());
    rows_.push_back(std::move(*row));
    point_.push_back(j);
  }
  v_ = Eigen::Map<const Vector>(v.data(), static_cast<Eigen::Index>(v.size()));
  a_ = Eigen::Map<const Vector>(a.data(), static_cast<Eigen::Index>(a.size()));
  SeriesNoise noise{input.autocovariance, {}};
  if (!input.noise_factor.empty()) {
    const auto from = input.noise_factor.begin() + static_cast<std::ptrdiff_t>(piece.first);
    noise.factor.assign(from, from + static_cast<std::ptrdiff_t>(piece.count));
  }
  aa_ = covariance_of(rows_, noise, of_a, of_a);
  av_ = covariance_of(rows_, noise, of_a, of_v);
  vv_ = covariance_of(rows_, noise, of_v, of_v);
}

bool LineNodes::well_conditioned(double k) const {
  const Sparse c = covariance(k);
  const BandedCholesky cholesky(c);
  if (cholesky.info() != Eigen::Success) return false;
  const Vector diagonal = c.diagonal(), pivot = Sparse(cholesky.matrixL()).diagonal();
  return (pivot.array().square() > kLeastPivot * diagonal.array()).all();
}

NodeResidual LineNodes::residual(double k) const {
  NodeResidual made{a_ + k * v_, Vector::Ones(count())};
  if (forced_) return made;
  const double middle = 0.5 * (t_.front() + t_.back());
  std::vector<double> phi(t_.size()), psi(t_.size());
  for (std::size_t i = 0; i < t_.size(); ++i) {
    const LawFunctions at = law_functions(k, t_[i] - middle);
    phi[i] = at.phi;
    psi[i] = at.psi;
  }
  Vector q(count()), v_of_phi(count()), v_of_psi(count());
  for (int j = 0; j < count(); ++j) {
    const SmoothedPoint of_phi = weighted_sums(rows_[static_cast<std::size_t>(j)], phi);
    const SmoothedPoint of_psi = weighted_sums(rows_[static_cast<std::size_t>(j)], psi);
    v_of_phi[j] = of_phi.v_m_s;
    v_of_psi[j] = of_psi.v_m_s;
    q[j] = of_phi.a_m_s2 + k * of_phi.v_m_s;
    made.p[j] = of_psi.a_m_s2 + k * of_psi.v_m_s;
  }
  // v0 = alpha - a0 beta by least squares of the smoothed v.
  const double norm = v_of_phi.squaredNorm();
  made.y -= v_of_phi.dot(v_) / norm * q;
  made.p -= v_of_phi.dot(v_of_psi) / norm * q;
  return made;
}

Vector LineNodes::change(const std::vector<double>& displacement, double k) const {
  const std::span of_piece = std::span(displacement).subspan(piece_.first, piece_.count);
  Vector moved(count());
  for (int j = 0; j < count(); ++j) {
    const SmoothedPoint point = weighted_sums(rows_[static_cast<std::size_t>(j)], of_piece);
    moved[j] = point.a_m_s2 + k * point.v_m_s;
  }
  return moved;
}

Vector LineNodes::force_part() const {
  return Eigen::Map<const Vector>(force_part_.data(), count());
}

Vector LineNodes::law_bias(const std::vector<double>& law_m_s2) const {
  std::vector<double> place(t_.size(), 0.0);
  double v = 0.0;
  for (std::size_t i = 1; i < t_.size(); ++i) {
    const double dt = t_[i] - t_[i - 1], before = law_m_s2[piece_.first + i - 1], after = law_m_s2[piece_.first + i];
    place[i] = place[i - 1] + v * dt + dt * dt * (2.0 * before + after) / 6.0;
    v += 0.5 * dt * (before + after);
  }
  Vector bias(count());
  for (int j = 0; j < count(); ++j) {
    const auto node = static_cast<std::size_t>(j);
    bias[j] = weighted_sums(rows_[node], place).a_m_s2 - law_m_s2[piece_.first + point_[node]];
  }
  return bias;
}

}  // namespace glidelab::core
