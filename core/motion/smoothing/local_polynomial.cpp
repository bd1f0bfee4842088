#include "core/motion/smoothing/local_polynomial.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/math/least_squares.h"
#include "core/math/quantile.h"
#include "core/motion/smoothing/grid_block.h"

namespace glidelab::core {
namespace {

constexpr double kUniform = 1e-9;  // steps that differ by less than this fraction count as equal
constexpr std::size_t kMostPolynomials = 6;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool has_tails(Kernel kernel) {
  return kernel == Kernel::gaussian || kernel == Kernel::bimodal;
}

/// The weights of points at u (in bandwidths) with the kernel's values; false if they do not determine the polynomial.
bool polynomial_weights(int order, const std::vector<double>& u, const std::vector<double>& kernel, double bandwidth_s,
                        KernelWeights& weights) {
  const auto basis = OrthogonalPolynomials::make(order, u, kernel);
  if (!basis) return false;
  const std::size_t n = u.size();
  const std::vector<double> at_zero = basis->derivatives(0.0, 2);
  weights.x.resize(n);
  weights.v.resize(n);
  weights.a.resize(order >= 2 ? n : 0);
  struct Share {
    double x = 0.0, v = 0.0, a = 0.0;
    const double* polynomial = nullptr;
  };
  std::array<Share, kMostPolynomials> shares;
  for (int k = 0; k <= order; ++k) {
    const double* const d = at_zero.data() + 3 * k;
    const double per_norm = 1.0 / basis->norm(k);
    shares[static_cast<std::size_t>(k)] = {d[0] * per_norm, d[1] * per_norm / bandwidth_s,
                                           d[2] * per_norm / (bandwidth_s * bandwidth_s), basis->at_points(k).data()};
  }
  const auto used = std::span(shares).first(static_cast<std::size_t>(order) + 1);
  const auto sum_to = [&](std::vector<double>& to, double Share::*part) {
    if (used.size() == 4) {  // the usual order, in one pass
      const double c0 = used[0].*part, c1 = used[1].*part, c2 = used[2].*part, c3 = used[3].*part;
      const double *const p0 = used[0].polynomial, *const p1 = used[1].polynomial, *const p2 = used[2].polynomial,
                          *const p3 = used[3].polynomial;
      for (std::size_t i = 0; i < to.size(); ++i)
        to[i] = kernel[i] * (c0 * p0[i] + c1 * p1[i] + c2 * p2[i] + c3 * p3[i]);
      return;
    }
    std::ranges::fill(to, 0.0);
    for (const Share& share : used) {
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += share.*part * (kernel[i] * share.polynomial[i]);
    }
  };
  sum_to(weights.x, &Share::x);
  sum_to(weights.v, &Share::v);
  sum_to(weights.a, &Share::a);
  return true;
}

}  // namespace

double kernel_value(Kernel kernel, double s) {
  const double r = std::abs(s);
  switch (kernel) {
    case Kernel::gaussian:
      return std::exp(-0.5 * s * s);
    case Kernel::epanechnikov:
      return r < 1.0 ? 1.0 - s * s : 0.0;
    case Kernel::tricube:
      return r < 1.0 ? std::pow(1.0 - r * r * r, 3) : 0.0;
    case Kernel::uniform:
      return r <= 1.0 + kUniform ? 1.0 : 0.0;
    case Kernel::bimodal:
      return s * s * std::exp(-s * s);
  }
  assert(false);
  return 0.0;
}

LocalPolynomial::LocalPolynomial(std::span<const double> t_s, PolynomialOptions options)
    : t_s_(t_s.begin(), t_s.end()), options_(std::move(options)) {
  assert(options_.bandwidth_s > 0.0 && options_.order >= 1 && options_.order <= 5 && options_.reach > 0.0);
  assert(options_.weights.empty() || options_.weights.size() == t_s.size());
  const double bandwidth = options_.bandwidth_s;
  reach_s_ = (has_tails(options_.kernel) ? options_.reach : 1.0) * bandwidth * (1.0 + kUniform);
  if (t_s_.size() < static_cast<std::size_t>(options_.order) + 2 || !options_.weights.empty()) return;
  const double step = median_step(t_s_);
  if (!(step > 0.0)) return;
  const auto half = static_cast<std::size_t>(std::min(reach_s_ / step, 1e9));
  run_.assign(t_s_.size(), 0);
  std::size_t longest = 0;
  for (std::size_t j = 1; j < t_s_.size(); ++j) {
    if (std::abs(t_s_[j] - t_s_[j - 1] - step) <= kUniform * step) run_[j] = run_[j - 1] + 1;
    longest = std::max(longest, run_[j]);
  }
  kernel_.resize(std::min(half, longest) + 1);
  for (std::size_t i = 0; i < kernel_.size(); ++i) {
    kernel_[i] = kernel_value(options_.kernel, static_cast<double>(i) * step / bandwidth);
  }
  // All weights are above 0 but those in the middle and at the edge, where a kernel may vanish.
  const auto some = std::span(kernel_).subspan(1, std::max<std::size_t>(kernel_.size(), 2) - 2);
  if (options_.order == 3 && half >= 6 && std::ranges::all_of(some, [](double k) { return k > 0.0; })) {
    steps_within_ = half;
    step_s_ = step;
  }
  if (half < 2 || longest < 2 * half) return;
  std::vector<double> u(2 * half + 1), kernel(2 * half + 1);
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = (static_cast<double>(i) - static_cast<double>(half)) * step / bandwidth;
    kernel[i] = kernel_[i < half ? half - i : i - half];
  }
  auto weights = std::make_shared<KernelWeights>();
  if (std::count_if(kernel.begin(), kernel.end(), [](double k) { return k > 0.0; }) < options_.order + 2) return;
  if (!polynomial_weights(options_.order, u, kernel, bandwidth, *weights)) return;
  half_ = half;
  filter_ = std::move(weights);
}

bool LocalPolynomial::interior(std::size_t j) const {
  return half_ > 0 && j >= half_ && j + half_ < t_s_.size() && run_[j + half_] >= 2 * half_;
}

/// If a point's window has the uniform step, the kernel's values are known (its weights are exact for any kernel).
std::optional<KernelRow> LocalPolynomial::general_row(double at_s, std::optional<std::size_t> point) const {
  const auto from = std::lower_bound(t_s_.begin(), t_s_.end(), at_s - reach_s_);
  const auto to = std::upper_bound(from, t_s_.end(), at_s + reach_s_);
  const auto first = static_cast<std::size_t>(from - t_s_.begin());
  std::vector<double> u(static_cast<std::size_t>(to - from)), kernel(u.size());
  const std::size_t before = point ? *point - first : 0, after = u.size() - before - 1;
  const bool uniform = point && std::max(before, after) < kernel_.size() && run_[first + u.size() - 1] + 1 >= u.size();
  int within = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = (t_s_[first + i] - at_s) / options_.bandwidth_s;
    kernel[i] = uniform ? kernel_[i < before ? before - i : i - before] : kernel_value(options_.kernel, u[i]);
    if (kernel[i] > 0.0) ++within;
    if (!options_.weights.empty()) kernel[i] *= options_.weights[first + i];
  }
  if (within < options_.order + 2) return {};
  auto weights = std::make_shared<KernelWeights>();
  if (!polynomial_weights(options_.order, u, kernel, options_.bandwidth_s, *weights)) return {};
  return KernelRow{first, std::move(weights)};
}

std::optional<KernelRow> LocalPolynomial::row(double at_s) const {
  const auto found = std::lower_bound(t_s_.begin(), t_s_.end(), at_s);
  if (found != t_s_.end() && *found == at_s) return row_of_point(static_cast<std::size_t>(found - t_s_.begin()));
  return general_row(at_s);
}

std::optional<KernelRow> LocalPolynomial::row_of_point(std::size_t j) const {
  assert(j < t_s_.size());
  if (interior(j)) return KernelRow{j - half_, filter_};
  return general_row(t_s_[j], j);
}

/// Whether the window has even steps wherever the series goes on, so that the table of the kernel holds all its
/// weights; and enough points with a weight, for of eight at most three have none: the middle one and the outermost.
bool LocalPolynomial::cut_off(std::size_t j) const {
  if (steps_within_ == 0 || interior(j)) return false;
  const std::size_t first = j - std::min(j, steps_within_), last = std::min(j + steps_within_, t_s_.size() - 1);
  return last - first >= 7 && run_[last] >= last - first;
}

void LocalPolynomial::filter(std::span<const double> values, std::size_t from, std::size_t to,
                             std::vector<std::optional<SmoothedPoint>>& out) const {
  const bool has_a = !filter_->a.empty();
  const auto from_middle = [&](const std::vector<double>& of) { return std::span(of).subspan(half_); };
  const GridFilter weights{from_middle(filter_->x), from_middle(filter_->v),
                           from_middle(has_a ? filter_->a : filter_->x)};
  const auto put = [&](std::size_t start, std::size_t count, const double* middle) {
    const GridBlock block = filter_block(weights, middle);
    for (std::size_t i = 0; i < count; ++i) {
      out[start + i] = SmoothedPoint{block.x[i], block.v[i], has_a ? block.a[i] : kNone};
    }
  };
  std::size_t start = from;
  for (; start + kGridLanes <= to; start += kGridLanes) put(start, kGridLanes, values.data() + start);
  if (start == to) return;
  std::vector<double> last(2 * half_ + kGridLanes, 0.0);  // fewer than eight: no value after them is read
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(start - half_), to - start + 2 * half_, last.begin());
  put(start, to - start, last.data() + half_);
}

void LocalPolynomial::fit_end(const GridEnds& ends, std::span<const double> values, std::size_t from, std::size_t to,
                              std::vector<std::optional<SmoothedPoint>>& out, const base::StopCheck& stop_check) const {
  const std::size_t lags = ends.lags(), n = t_s_.size();
  const double origin = values[from];  // relative to it, so that a distant origin costs no digits
  // From `lags` before the first point to `lags` after the last of eight; 0 where the series does not go.
  const std::size_t blocks = (to - from + kGridLanes - 1) / kGridLanes;
  std::vector<double> padded(2 * lags + blocks * kGridLanes, 0.0);
  for (std::size_t i = from - std::min(from, lags); i < std::min(to + lags, n); ++i) {
    padded[i + lags - from] = values[i] - origin;
  }
  for (std::size_t start = from; start < to; start += kGridLanes) {
    stop_check();
    std::array<std::size_t, kGridLanes> before{}, after{};
    const std::size_t count = std::min(kGridLanes, to - start);
    for (std::size_t i = 0; i < kGridLanes; ++i) {
      const std::size_t j = start + std::min(i, count - 1);
      before[i] = std::min(j, lags);
      after[i] = std::min(n - 1 - j, lags);
    }
    const GridBlock block = ends.solve(padded.data() + (start - from) + lags, before, after);
    for (std::size_t i = 0; i < count; ++i) {
      if (block.determined[i]) {
        out[start + i] = SmoothedPoint{block.x[i] + origin, block.v[i], block.a[i]};
      } else if (const auto row = general_row(t_s_[start + i], start + i)) {
        out[start + i] = weighted_sums(*row, values);
      }
    }
  }
}

std::vector<std::optional<SmoothedPoint>> LocalPolynomial::smooth(std::span<const double> values,
                                                                  const base::StopCheck& stop_check) const {
  constexpr std::size_t kUnchecked = 512 * kGridLanes;  // points: whole blocks, so that the bits stay the same
  assert(values.size() == t_s_.size());
  std::vector<std::optional<SmoothedPoint>> out(t_s_.size());
  const auto end_of = [&](std::size_t j, bool (LocalPolynomial::*alike)(std::size_t) const) {
    while (j < t_s_.size() && (this->*alike)(j)) ++j;
    return j;
  };
  std::optional<GridEnds> ends;
  for (std::size_t j = 0; j < t_s_.size();) {
    stop_check();
    if (const std::size_t to = end_of(j, &LocalPolynomial::interior); to > j) {
      for (; j < to; j = std::min(j + kUnchecked, to)) {
        stop_check();
        filter(values, j, std::min(j + kUnchecked, to), out);
      }
    } else if (const std::size_t end = end_of(j, &LocalPolynomial::cut_off); end > j) {
      if (!ends) ends.emplace(kernel_, step_s_ / options_.bandwidth_s, options_.bandwidth_s);
      fit_end(*ends, values, j, end, out, stop_check);
      j = end;
    } else {
      if (const auto row = general_row(t_s_[j], j)) out[j] = weighted_sums(*row, values);
      ++j;
    }
  }
  return out;
}

SmoothedPoint weighted_sums(const KernelRow& row, std::span<const double> values) {
  const KernelWeights& weights = *row.weights;
  assert(row.first + weights.x.size() <= values.size());
  // Relative to the first value, so that a distant origin costs no digits.
  const double origin = values[row.first];
  using Numbers = Eigen::Map<const Eigen::ArrayXd>;
  const auto count = static_cast<Eigen::Index>(weights.x.size());
  const Numbers value(values.data() + row.first, count);
  const auto sum = [&](const std::vector<double>& of) { return (Numbers(of.data(), count) * (value - origin)).sum(); };
  SmoothedPoint point;
  point.x_m = sum(weights.x);
  point.v_m_s = sum(weights.v);
  point.a_m_s2 = weights.a.empty() ? std::numeric_limits<double>::quiet_NaN() : sum(weights.a);
  point.x_m += origin;
  return point;
}

double noise_variance(std::span<const double> weights, std::span<const double> autocovariance) {
  double variance = 0.0;
  for (std::size_t lag = 0; lag < autocovariance.size() && lag < weights.size(); ++lag) {
    const auto count = static_cast<Eigen::Index>(weights.size() - lag);
    using Numbers = Eigen::Map<const Eigen::VectorXd>;
    const double product = Numbers(weights.data(), count).dot(Numbers(weights.data() + lag, count));
    variance += (lag == 0 ? 1.0 : 2.0) * autocovariance[lag] * product;
  }
  return variance;
}

double noise_covariance(std::size_t first, std::span<const double> weights, std::size_t other_first,
                        std::span<const double> other, const SeriesNoise& noise) {
  const auto factor = [&](std::size_t point) { return noise.factor.empty() ? 1.0 : noise.factor[point]; };
  const auto lags = static_cast<std::ptrdiff_t>(noise.autocovariance.size());
  const auto from = static_cast<std::ptrdiff_t>(other_first), count = static_cast<std::ptrdiff_t>(other.size());
  double covariance = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const auto point = static_cast<std::ptrdiff_t>(first + i);
    const std::ptrdiff_t begin = std::max(from, point - lags + 1), end = std::min(from + count, point + lags);
    double sum = 0.0;
    for (std::ptrdiff_t p = begin; p < end; ++p) {
      const auto lag = static_cast<std::size_t>(p > point ? p - point : point - p);
      sum +=
          noise.autocovariance[lag] * factor(static_cast<std::size_t>(p)) * other[static_cast<std::size_t>(p - from)];
    }
    covariance += weights[i] * factor(first + i) * sum;
  }
  return covariance;
}

Eigen::Matrix3d point_covariance(const KernelRow& row, const KernelRow& other, const SeriesNoise& noise) {
  assert(!row.weights->a.empty() && !other.weights->a.empty());
  const std::vector<double>* const left[] = {&row.weights->x, &row.weights->v, &row.weights->a};
  const std::vector<double>* const right[] = {&other.weights->x, &other.weights->v, &other.weights->a};
  Eigen::Matrix3d covariance;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) covariance(r, c) = noise_covariance(row.first, *left[r], other.first, *right[c], noise);
  }
  return covariance;
}

const RowVariance::Variances& RowVariance::of(const KernelRow& row) {
  if (row.weights != known_) {
    known_ = row.weights;
    variances_ = {noise_variance(known_->x, autocovariance_), noise_variance(known_->v, autocovariance_),
                  noise_variance(known_->a, autocovariance_)};
  }
  return variances_;
}

}  // namespace glidelab::core
