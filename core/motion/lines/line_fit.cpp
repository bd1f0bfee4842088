#include "core/motion/lines/line_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/math/least_squares.h"
#include "core/math/quantile.h"
#include "core/result/estimate.h"

namespace glidelab::core {
namespace {

Eigen::Matrix2d normal_matrix(const std::vector<double>& v_m_s) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  for (const double v : v_m_s) {
    const Eigen::Vector2d design(-v, 1.0);
    normal += design * design.transpose();
  }
  return normal;
}

/// (A'A)^-1 A' y
Eigen::Vector2d coefficients(const Eigen::Matrix2d& inverse, const std::vector<double>& v_m_s,
                             const std::vector<double>& y) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t j = 0; j < y.size(); ++j) sum += Eigen::Vector2d(-v_m_s[j], 1.0) * y[j];
  return inverse * sum;
}

LineShift shift_by(const LineInput& input, const Eigen::Matrix2d& inverse, const Eigen::Vector2d& line,
                   const std::vector<MotionShift>& mode) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t j = 0; j < mode.size(); ++j) {
    const Eigen::Vector2d design(-input.v_m_s[j], 1.0);
    const double residual = input.a_m_s2[j] - design.dot(line);
    sum += design * (mode[j].a_m_s2 + line[0] * mode[j].v_m_s);
    sum[0] -= mode[j].v_m_s * residual;
  }
  const Eigen::Vector2d change = inverse * sum;
  return {change[0], change[1]};
}

/// The rows L_k, L_a0 over all positions, for noise of factor 1.
struct CoefficientRows {
  std::vector<double> k, a0;
};

CoefficientRows rows_of(const LineInput& input, const Eigen::Matrix2d& inverse, double k) {
  CoefficientRows made{std::vector<double>(input.track_points, 0.0), std::vector<double>(input.track_points, 0.0)};
  for (std::size_t j = 0; j < input.rows.size(); ++j) {
    const Eigen::Vector2d gain = inverse * Eigen::Vector2d(-input.v_m_s[j], 1.0);
    const KernelWeights& weights = *input.rows[j].weights;
    for (std::size_t i = 0; i < weights.a.size(); ++i) {
      const double of_residual = weights.a[i] + k * weights.v[i];
      made.k[input.rows[j].first + i] += gain[0] * of_residual;
      made.a0[input.rows[j].first + i] += gain[1] * of_residual;
    }
  }
  for (std::size_t i = 0; i < input.noise_factor.size(); ++i) {
    made.k[i] *= input.noise_factor[i];
    made.a0[i] *= input.noise_factor[i];
  }
  return made;
}

double noise_covariance_of(const std::vector<double>& one, const std::vector<double>& other,
                           const std::vector<double>& autocovariance) {
  std::vector<double> sum(one.size()), difference(one.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    sum[i] = one[i] + other[i];
    difference[i] = one[i] - other[i];
  }
  return 0.25 * (noise_variance(sum, autocovariance) - noise_variance(difference, autocovariance));
}

/// L Sigma L'.
void propagate_noise(const LineInput& input, const Eigen::Matrix2d& inverse, double k,
                     const std::vector<double>& autocovariance, LineUncertainty& parts) {
  const CoefficientRows rows = rows_of(input, inverse, k);
  parts.var_k = noise_variance(rows.k, autocovariance);
  parts.var_a0 = noise_variance(rows.a0, autocovariance);
  std::vector<double> sum(rows.k.size());
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = rows.k[i] + rows.a0[i];
  parts.cov = 0.5 * (noise_variance(sum, autocovariance) - parts.var_k - parts.var_a0);
}

constexpr std::size_t kFewestBlocks = 8;

/// Effective number of independent residuals among `count`: their noise is correlated over the kernel.
double independent(const std::vector<double>& weights, std::size_t count) {
  double sum = 0.0, variance = 0.0;
  for (std::size_t lag = 0; lag < weights.size(); ++lag) {
    double product = 0.0;
    for (std::size_t i = 0; i + lag < weights.size(); ++i) product += weights[i] * weights[i + lag];
    if (lag == 0) variance = product;
    sum += (lag == 0 ? 1.0 : 2.0) * product * product / (variance * variance);
  }
  return std::max(1.0, static_cast<double>(count) / sum);
}

/// Sets parts.scatter, and widens the covariance if the scatter exceeds that of the noise.
void add_misfit(const LineInput& input, const Eigen::Matrix2d& inverse, const Eigen::Vector2d& line,
                const std::vector<double>& autocovariance, LineUncertainty& parts) {
  const std::size_t n = input.v_m_s.size();
  std::vector<double> residual(n);
  for (std::size_t j = 0; j < n; ++j) residual[j] = input.a_m_s2[j] - (line[1] - line[0] * input.v_m_s[j]);
  const Scatter scatter = scatter_of(input, residual, line[0], autocovariance);
  parts.scatter = std::sqrt(scatter.ratio);
  if (!scatter.significant()) return;
  const std::size_t length = std::max<std::size_t>(1, n / kFewestBlocks);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  double blocks = 0.0;
  for (std::size_t from = 0; from < n;) {
    Eigen::Vector2d score = Eigen::Vector2d::Zero();
    std::size_t to = from;
    for (; to < n && to < from + length && input.stretch[to] == input.stretch[from]; ++to) {
      score += Eigen::Vector2d(-input.v_m_s[to], 1.0) * residual[to];
    }
    sum += score * score.transpose();
    blocks += 1.0;
    from = to;
  }
  if (blocks < 3.0) return;
  const Eigen::Matrix2d wider = inverse * sum * inverse * ((1.0 - 1.0 / scatter.ratio) * blocks / (blocks - 2.0));
  const double total = parts.var_a0 + wider(1, 1);
  // Welch-Satterthwaite: the part from the blocks has blocks - 2 degrees of freedom.
  parts.degrees = std::max(1.0, (blocks - 2.0) * total * total / (wider(1, 1) * wider(1, 1)));
  parts.var_k += wider(0, 0);
  parts.cov += wider(0, 1);
  parts.var_a0 = total;
}

constexpr std::size_t kFewestStretches = 4;

/// Delete-one-stretch jackknife: how far the line moves when one stretch is left out. It uses no noise model, and
/// replaces the covariance if it is the larger one.
void compare_with_jackknife(const LineInput& input, const Eigen::Matrix2d& normal, const Eigen::Vector2d& line,
                            LineUncertainty& parts) {
  std::vector<Eigen::Vector2d> without;
  for (std::size_t from = 0; from < input.stretch.size();) {
    Eigen::Matrix2d part = Eigen::Matrix2d::Zero();
    Eigen::Vector2d score = Eigen::Vector2d::Zero();
    std::size_t to = from;
    for (; to < input.stretch.size() && input.stretch[to] == input.stretch[from]; ++to) {
      const Eigen::Vector2d design(-input.v_m_s[to], 1.0);
      part += design * design.transpose();
      score += design * (input.a_m_s2[to] - design.dot(line));
    }
    const Eigen::Matrix2d rest = normal - part;
    if (!(rest.determinant() > 1e-9 * normal.determinant())) return;  // one stretch alone determines the line
    without.push_back(-(rest.inverse() * score));
    from = to;
  }
  if (without.size() < kFewestStretches) return;
  if (widen_by_jackknife(without, parts)) parts.jackknife = true;
}

}  // namespace

LineCross cross_covariance(const LineInput& one, const LineFit& of_one, const LineInput& other, const LineFit& of_other,
                           const std::vector<double>& autocovariance) {
  const CoefficientRows a = rows_of(one, normal_matrix(one.v_m_s).inverse(), of_one.k_over_m_1_s.value);
  const CoefficientRows b = rows_of(other, normal_matrix(other.v_m_s).inverse(), of_other.k_over_m_1_s.value);
  return {noise_covariance_of(a.k, b.k, autocovariance), noise_covariance_of(a.k, b.a0, autocovariance),
          noise_covariance_of(a.a0, b.k, autocovariance), noise_covariance_of(a.a0, b.a0, autocovariance)};
}

bool speed_varies(const LineInput& input, const std::vector<double>& autocovariance) {
  constexpr double kLeastOverNoise = 9.0;  // of variances: three standard deviations
  const std::size_t n = input.v_m_s.size();
  if (n == 0) return false;
  double mean = 0.0;
  std::vector<double> of_mean(input.track_points, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    mean += input.v_m_s[j] / static_cast<double>(n);
    const std::vector<double>& weights = input.rows[j].weights->v;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      of_mean[input.rows[j].first + i] += weights[i] / static_cast<double>(n);
    }
  }
  double squares = 0.0, of_noise = 0.0;
  for (std::size_t j = 0; j < n; ++j) {
    squares += std::pow(input.v_m_s[j] - mean, 2);
    std::vector<double> off = of_mean;
    const std::vector<double>& weights = input.rows[j].weights->v;
    for (std::size_t i = 0; i < weights.size(); ++i) off[input.rows[j].first + i] -= weights[i];
    for (std::size_t i = 0; i < input.noise_factor.size(); ++i) off[i] *= input.noise_factor[i];
    of_noise += noise_variance(off, autocovariance);
  }
  return squares >= kLeastOverNoise * of_noise;
}

Scatter scatter_of(const LineInput& input, const std::vector<double>& residual, double k_1_s,
                   const std::vector<double>& autocovariance) {
  double squares = 0.0, expected = 0.0, variance = 0.0;
  std::vector<double> weights;
  const KernelWeights* known = nullptr;
  for (std::size_t j = 0; j < residual.size(); ++j) {
    squares += residual[j] * residual[j];
    if (input.rows[j].weights.get() != known) {
      known = input.rows[j].weights.get();
      weights = known->a;
      for (std::size_t i = 0; i < weights.size(); ++i) weights[i] += k_1_s * known->v[i];
      variance = noise_variance(weights, autocovariance);
    }
    // Speed-dependent noise changes little over a kernel.
    const std::size_t middle = input.rows[j].first + weights.size() / 2;
    const double factor = input.noise_factor.empty() ? 1.0 : input.noise_factor[middle];
    expected += factor * factor * variance;
  }
  if (!(expected > 0.0)) return {};
  return {squares / expected, chi2_ratio_limit(independent(weights, residual.size()))};
}

std::optional<LineFit> fit_line(int direction, const LineInput& input, const std::vector<double>& autocovariance,
                                double scale_sd_relative, Misfit misfit) {
  assert(input.v_m_s.size() == input.a_m_s2.size() && input.rows.size() == input.v_m_s.size());
  if (input.v_m_s.size() < kFewestLinePoints) return {};
  const Eigen::Matrix2d normal = normal_matrix(input.v_m_s);
  if (!(normal.determinant() > 1e-12 * normal(0, 0) * normal(1, 1))) return {};
  const Eigen::Matrix2d inverse = normal.inverse();
  const Eigen::Vector2d line = coefficients(inverse, input.v_m_s, input.a_m_s2);
  LineFit fit;
  fit.direction = direction;
  fit.points = input.v_m_s.size();
  fit.k_over_m_1_s.value = line[0];
  fit.a0_m_s2.value = line[1];
  PairCorrelation correlation;
  correlation.add(input.v_m_s, input.a_m_s2);
  fit.r2 = correlation.squared();
  const auto [low, high] = std::minmax_element(input.v_m_s.begin(), input.v_m_s.end());
  fit.from_v_m_s = *low;
  fit.to_v_m_s = *high;
  fit.parts.degrees = std::numeric_limits<double>::infinity();
  propagate_noise(input, inverse, line[0], autocovariance, fit.parts);
  if (misfit == Misfit::widens) {
    add_misfit(input, inverse, line, autocovariance, fit.parts);
    compare_with_jackknife(input, normal, line, fit.parts);
  }
  const Eigen::Vector2d bias = coefficients(inverse, input.v_m_s, input.bias_a_m_s2);
  fit.parts.smoothing_k = bias[0];
  fit.parts.smoothing_a0 = bias[1];
  const Eigen::Vector2d mass = coefficients(inverse, input.v_m_s, input.mass_part_m_s2);
  fit.parts.mass_k = mass[0];
  fit.parts.mass_a0 = mass[1];
  fit.parts.scale_relative = scale_sd_relative;
  for (const std::vector<MotionShift>& mode : input.calibration) {
    fit.parts.calibration.push_back(mode.empty() ? LineShift{} : shift_by(input, inverse, line, mode));
  }
  complete_line(fit);
  return fit;
}

std::vector<LineShift> shared_shifts(const LineFit& line) {
  const LineUncertainty& parts = line.parts;
  const LineShift law = parts.law ? parts.law->shift : LineShift{};
  std::vector<LineShift> shifts{
      {parts.smoothing_k, parts.smoothing_a0},
      law,
      {parts.mass_k, parts.mass_a0},
      {0.0, parts.scale_relative * line.a0_m_s2.value},
      {kClockSdRelative * line.k_over_m_1_s.value, 2.0 * kClockSdRelative * line.a0_m_s2.value}};
  shifts.insert(shifts.end(), parts.calibration.begin(), parts.calibration.end());
  return shifts;
}

KnownVariance random_variance(const LineFit& line, const LineShift& gradient) {
  const LineUncertainty& parts = line.parts;
  const double own = gradient.k * gradient.k * parts.var_k + gradient.a0 * gradient.a0 * parts.var_a0 +
                     2.0 * gradient.k * gradient.a0 * parts.cov;
  double of_clips = 0.0;
  for (const LineShift& shift : parts.clips) of_clips += std::pow(gradient.k * shift.k + gradient.a0 * shift.a0, 2);
  // The second is what the clips' scatter adds to the first. It is not independent of it; the degrees of the sum are
  // those with which two clips that scatter have intervals of 95 % (tests/core/motion/test_configurations.cpp
  // counts it).
  return sum_of({own, parts.degrees}, {std::max(0.0, of_clips - own), parts.clip_degrees});
}

void complete_line(LineFit& line) {
  const LineUncertainty& parts = line.parts;
  const KnownVariance of_k = random_variance(line, {1.0, 0.0}), of_a0 = random_variance(line, {0.0, 1.0});
  double known_k = 0.0, known_a0 = 0.0;
  line.covariance = parts.cov;
  // What the clips' scatter adds has the correlation of that scatter, also where it adds to one of the variances alone:
  // the correlation is then a mean of both, and no correlation lies beyond 1.
  LineUncertainty scatter;
  for (const LineShift& shift : parts.clips) {
    scatter.var_k += shift.k * shift.k;
    scatter.var_a0 += shift.a0 * shift.a0;
    scatter.cov += shift.k * shift.a0;
  }
  if (scatter.var_k > 0.0 && scatter.var_a0 > 0.0) {
    const double correlation = scatter.cov / std::sqrt(scatter.var_k * scatter.var_a0);
    line.covariance += correlation * (std::sqrt(of_k.value * of_a0.value) - std::sqrt(parts.var_k * parts.var_a0));
  }
  for (const LineShift& shift : shared_shifts(line)) {
    known_k += shift.k * shift.k;
    known_a0 += shift.a0 * shift.a0;
    line.covariance += shift.k * shift.a0;
  }
  line.k_over_m_1_s = estimate(line.k_over_m_1_s.value, of_k, known_k);
  line.a0_m_s2 = estimate(line.a0_m_s2.value, of_a0, known_a0);
}

Quantity limit_velocity(const std::vector<LineFit>& lines) {
  const auto found = std::find_if(lines.begin(), lines.end(), [](const LineFit& line) { return line.direction > 0; });
  if (found == lines.end()) return undetermined(unknown::NoDownhillLine{});
  if (const auto why_not = why_no_limit_velocity(found->k_over_m_1_s, {.of_line = true}, found->a0_m_s2)) {
    return undetermined(*why_not);
  }
  const double k = found->k_over_m_1_s.value, a0 = found->a0_m_s2.value;
  const double by_k = -a0 / (k * k), by_a0 = 1.0 / k;
  const KnownVariance random = random_variance(*found, {by_k, by_a0});
  double known = 0.0;
  for (const LineShift& shift : shared_shifts(*found)) known += std::pow(by_k * shift.k + by_a0 * shift.a0, 2);
  return determined(estimate(a0 / k, random, known), std::sqrt(random.value));
}

bool widen_by_jackknife(const std::vector<Eigen::Vector2d>& moved, LineUncertainty& parts) {
  assert(moved.size() >= 3);
  const auto n = static_cast<double>(moved.size());
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& by : moved) covariance += by * by.transpose() * ((n - 1.0) / n);
  if (covariance(1, 1) <= chi2_ratio_limit(n - 1.0) * parts.var_a0 &&
      covariance(0, 0) <= chi2_ratio_limit(n - 1.0) * parts.var_k) {
    return false;
  }
  // No variance falls below that from the noise; the correlation is the jackknife's.
  const double correlation = covariance(0, 1) / std::max(std::sqrt(covariance(0, 0) * covariance(1, 1)), 1e-300);
  parts.var_k = std::max(covariance(0, 0), parts.var_k);
  parts.var_a0 = std::max(covariance(1, 1), parts.var_a0);
  parts.cov = correlation * std::sqrt(parts.var_k * parts.var_a0);
  parts.degrees = n - 2.0;
  return true;
}

namespace {

/// Variance of a over that of the noise, for a complete kernel over uniform points of the median step.
double complete_variance(double step_s, double bandwidth_s) {
  const auto half = static_cast<std::size_t>(std::ceil(kKernelReach * bandwidth_s / step_s)) + 1;
  std::vector<double> t(2 * half + 1);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<double>(i) * step_s;
  const auto row = LocalCubic(t, bandwidth_s).row_of_point(half);
  return row ? noise_variance(row->weights->a, std::vector<double>{1.0}) : 0.0;
}

}  // namespace

std::vector<StretchPoint> smooth_stretches(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                           double bandwidth_s, std::size_t stride, WantedPoints wanted) {
  std::vector<StretchPoint> points;
  const double allowed = kGapVariance * complete_variance(motion.step_s, bandwidth_s);
  const double margin = kKernelMargin * bandwidth_s * (1.0 - 1e-9);
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const FreeStretch& stretch = stretches[s];
    const std::span t = std::span(motion.t_s).subspan(stretch.first, stretch.count);
    const std::span x = std::span(motion.x_m).subspan(stretch.first, stretch.count);
    const std::span y = std::span(motion.y_m).subspan(stretch.first, stretch.count);
    const LocalCubic cubic(t, bandwidth_s);
    RowVariance variance({1.0});
    for (std::size_t j = 0; j < t.size(); j += stride) {
      const double since = t[j] - t.front(), until = t.back() - t[j];
      const bool in_margin = since < margin || until < margin;
      if (wanted == WantedPoints::inner && (in_margin || stretch.whole != LeftOut::used)) continue;
      StretchPoint point;
      point.point = stretch.first + j;
      point.stretch = s;
      point.direction = stretch.direction;
      point.row = cubic.row_of_point(j);
      if (point.row) {
        point.smoothed = true;
        point.x = weighted_sums(*point.row, x);
        point.y = motion.forced ? weighted_sums(*point.row, y) : point.x;
        point.row->first += stretch.first;
      }
      if (stretch.whole != LeftOut::used) {
        point.left_out = stretch.whole;
      } else if (in_margin) {
        point.left_out = since < until ? stretch.start : stretch.end;
      } else if (!point.row || variance.of_a(*point.row) > allowed) {
        point.left_out = LeftOut::kernel_gap;
      } else if (point.x.v_m_s * stretch.direction <= 0.0) {
        point.left_out = LeftOut::kernel_reversal;
      }
      points.push_back(std::move(point));
    }
  }
  return points;
}

std::vector<double> smoothing_bias(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<double>& law_m_s2, const std::vector<StretchPoint>& points) {
  std::vector<double> place(motion.t_s.size(), 0.0);  // double integral of the law, restarted in each stretch
  for (const FreeStretch& stretch : stretches) {
    double v = 0.0, x = 0.0;
    for (std::size_t i = stretch.first + 1; i < stretch.first + stretch.count; ++i) {
      const double dt = motion.t_s[i] - motion.t_s[i - 1];
      x += v * dt + dt * dt * (2.0 * law_m_s2[i - 1] + law_m_s2[i]) / 6.0;
      v += 0.5 * dt * (law_m_s2[i - 1] + law_m_s2[i]);
      place[i] = x;
    }
  }
  std::vector<double> bias;
  for (const StretchPoint& point : points) {
    bias.push_back(point.row ? weighted_sums(*point.row, place).a_m_s2 - law_m_s2[point.point] : 0.0);
  }
  return bias;
}

LineInput line_input(const Motion& motion, const std::vector<StretchPoint>& points, const std::vector<double>& bias,
                     int direction, double mass_kg, double mass_sd_kg) {
  LineInput input;
  input.track_points = motion.t_s.size();
  input.t_s = motion.t_s;
  input.forced = motion.forced;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const StretchPoint& point = points[j];
    if (point.direction != direction || point.left_out != LeftOut::used || !point.row) continue;
    input.v_m_s.push_back(point.x.v_m_s);
    input.a_m_s2.push_back(point.y.a_m_s2);
    input.rows.push_back(*point.row);
    input.stretch.push_back(point.stretch);
    input.bias_a_m_s2.push_back(bias[j]);
    // a - F/m with F/m = x'' - y''; for a heavier glider F/m is smaller.
    const double of_force = mass_sd_kg > 0.0 ? (point.x.a_m_s2 - point.y.a_m_s2) * mass_sd_kg / mass_kg : 0.0;
    input.mass_part_m_s2.push_back(of_force);
  }
  return input;
}

std::vector<std::vector<MotionShift>> calibration_shifts(const Motion& motion, const LineInput& input,
                                                         const std::vector<std::vector<double>>& shared_m) {
  std::vector<std::vector<MotionShift>> shifts(shared_m.size());
  for (std::size_t mode = 0; mode < shared_m.size(); ++mode) {
    if (shared_m[mode].empty()) continue;
    std::vector<double> displacement;
    for (const std::size_t point : motion.point) displacement.push_back(shared_m[mode][point]);
    for (const KernelRow& row : input.rows) {
      const SmoothedPoint smoothed = weighted_sums(row, displacement);
      shifts[mode].push_back({smoothed.v_m_s, smoothed.a_m_s2});
    }
  }
  return shifts;
}

}  // namespace glidelab::core
