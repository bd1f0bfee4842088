#include "core/motion/bandwidth/rule_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/math/least_squares.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/lines/line_fit.h"

namespace glidelab::core {
namespace {

constexpr double kNoiseOfPoints = 0.0125;       // target: noise of a over its standard deviation along the line
constexpr double kSlopeSeen = 3.0;              // standard deviations of K/m above which a line is not level
constexpr double kBiasAllowed = 0.0035;         // of the lines' size, allowed for quieter points
constexpr double kNoiseAllowed = 1.25;          // growth of the lines' variance, allowed for quieter points
constexpr double kShareOfTime = 0.1;            // of the free time; below it a direction does not count
constexpr double kPointsPerBandwidth = 3.0;     // closer points add no information
constexpr std::size_t kFewestOfLaw = 8;         // usable points needed for a pilot law
constexpr double kSpreadAboveRounding = 1e-12;  // of v, over its mean square

double time_of(const Motion& motion, const FreeStretch& stretch) {
  return motion.t_s[stretch.first + stretch.count - 1] - motion.t_s[stretch.first];
}

struct Errors {
  double bandwidth_s = 0.0;
  double random = 0.0;       // mean squared error of the lines from noise, m^2/s^4, sum over directions
  double biased = 0.0;       // the same from the kernel's bias
  double bias_share = 0.0;   // bias of a line over its size, of the worse direction
  double noise_share = 0.0;  // noise of a over its standard deviation along the line, of the noisier direction
  double square() const { return random + biased; }
};

/// Mean over 0 <= v <= top of (d a0 - v d k)^2 for the second moments (kk, ka, aa) of (d k, d a0).
double mean_square(double kk, double ka, double aa, double v_top) {
  return aa - v_top * ka + v_top * v_top / 3.0 * kk;
}

class Scan {
 public:
  Scan(const Motion& motion, const std::vector<FreeStretch>& stretches, const PositionNoise& noise, double pilot_s)
      : motion_(motion),
        stretches_(stretches),
        noise_(noise),
        law_(pilot_law(motion, stretches, law_bandwidth(motion, pilot_s))) {
    double total = 0.0, of_direction[2] = {};
    for (const FreeStretch& stretch : stretches) {
      const double time = time_of(motion, stretch);
      total += time;
      of_direction[stretch.direction > 0] += time;
      longest_s_ = std::max(longest_s_, time);
    }
    for (const int direction : {-1, 1}) {
      if (of_direction[direction > 0] > kShareOfTime * total) directions_.push_back(direction);
    }
  }

  double longest_s() const { return longest_s_; }

  /// Empty if a direction that counts has no line.
  std::optional<Errors> at(double bandwidth_s) {
    const auto stride =
        static_cast<std::size_t>(std::max(1.0, std::floor(bandwidth_s / (kPointsPerBandwidth * motion_.step_s))));
    const std::vector<StretchPoint> points =
        smooth_stretches(motion_, stretches_, bandwidth_s, stride, WantedPoints::inner);
    const std::vector<double> bias = smoothing_bias(motion_, stretches_, law_, points);
    Errors errors;
    errors.bandwidth_s = bandwidth_s;
    for (const int direction : directions_) {
      const LineInput input = line_input(motion_, points, bias, direction, 0.0, 0.0);
      const auto line = fit_line(direction, input, noise_.autocovariance, 0.0, Misfit::ignored);
      if (!line) return {};
      double& top = top_speed_[direction > 0];
      top = std::max({top, std::abs(line->from_v_m_s), std::abs(line->to_v_m_s)});
      const LineUncertainty& of = line->parts;
      const double v_top = direction * top, k = line->k_over_m_1_s.value, a0 = line->a0_m_s2.value;
      const double random = mean_square(of.var_k, of.cov, of.var_a0, v_top);
      const double biased = mean_square(of.smoothing_k * of.smoothing_k, of.smoothing_k * of.smoothing_a0,
                                        of.smoothing_a0 * of.smoothing_a0, v_top);
      errors.random += random;
      errors.biased += biased;
      errors.bias_share = std::max(errors.bias_share, std::sqrt(biased / mean_square(k * k, k * a0, a0 * a0, v_top)));
      errors.noise_share = std::max(errors.noise_share, noise_share(*line, input));
    }
    return errors;
  }

  /// Noise of a over the standard deviation of a along the line; 0 if the line may be level.
  double noise_share(const LineFit& line, const LineInput& input) const {
    if (std::abs(line.k_over_m_1_s.value) < kSlopeSeen * std::sqrt(line.parts.var_k)) return 0.0;
    RowVariance variance(noise_.autocovariance);
    double noise = 0.0, v = 0.0, vv = 0.0;
    for (std::size_t j = 0; j < input.rows.size(); ++j) {
      noise += variance.of_a(input.rows[j]);
      v += input.v_m_s[j];
      vv += input.v_m_s[j] * input.v_m_s[j];
    }
    const auto n = static_cast<double>(input.rows.size());
    const double spread = std::sqrt(std::max(1e-300, vv / n - v * v / (n * n)));
    return std::sqrt(noise / n) / (std::abs(line.k_over_m_1_s.value) * spread);
  }

  bool has_directions() const { return !directions_.empty(); }

 private:
  const Motion& motion_;
  const std::vector<FreeStretch>& stretches_;
  const PositionNoise& noise_;
  std::vector<double> law_;
  std::vector<int> directions_;
  double top_speed_[2] = {};  // the widest range of v seen, at the least bandwidth
  double longest_s_ = 0.0;
};

/// Weighted least squares of a = a0 - k v.
struct Law {
  double k = 0.0, a0 = 0.0;
};

/// The law of one direction, fitted to the points that count, or to all points if too few count; empty if there are
/// none.
///
/// The kernel's bias scales with k^2, which noise makes too large by the variance of k. That variance is subtracted
/// (leaving a constant if k is not distinguishable from 0). It is estimated from the residuals, each point counting as
/// independent. The smoothed a of neighbours cancel rather than add, so the true variance is somewhat smaller.
std::optional<Law> law_of_direction(const std::vector<StretchPoint>& points, int direction) {
  RowVariance variance({1.0});
  for (const bool only_used : {true, false}) {
    LineSums sums;
    double aa = 0.0;
    std::size_t n = 0;
    for (const StretchPoint& point : points) {
      if (point.direction != direction || !point.smoothed) continue;
      if (only_used && point.left_out != LeftOut::used) continue;
      const double weight = 1.0 / variance.of_a(*point.row);
      sums.add(weight, point.x.v_m_s, point.y.a_m_s2);
      aa += weight * point.y.a_m_s2 * point.y.a_m_s2;
      ++n;
    }
    if (n == 0 || (only_used && n < kFewestOfLaw)) continue;
    if (n <= 2 || !sums.is_regular(kSpreadAboveRounding)) return Law{0.0, sums.y / sums.w};
    const double slope = sums.slope(), spread = sums.determinant() / sums.w;
    const double squares = std::max(0.0, aa - sums.intercept() * sums.y - slope * sums.xy);
    const double variance_of_k = squares / (static_cast<double>(n - 2) * spread);
    Law law;
    law.k = std::copysign(std::sqrt(std::max(0.0, slope * slope - variance_of_k)), -slope);
    law.a0 = (sums.y + law.k * sums.x) / sums.w;
    return law;
  }
  return {};
}

}  // namespace

std::vector<double> pilot_law(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
  const std::vector<StretchPoint> points = smooth_stretches(motion, stretches, bandwidth_s);
  std::vector<double> law(motion.t_s.size(), 0.0);
  for (const int direction : {-1, 1}) {
    const auto of_v = law_of_direction(points, direction);
    if (!of_v) continue;
    for (const StretchPoint& point : points) {
      if (point.direction == direction && point.smoothed) law[point.point] = of_v->a0 - of_v->k * point.x.v_m_s;
    }
  }
  return law;
}

double law_bandwidth(const Motion& motion, double pilot_bandwidth_s) {
  return std::max(0.5 * pilot_bandwidth_s, kLeastBandwidthSteps * motion.step_s);
}

BandwidthChoice choose_bandwidth(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                 const PositionNoise& noise, double pilot_bandwidth_s) {
  BandwidthChoice choice;
  choice.bandwidth_s = pilot_bandwidth_s;
  choice.method = chosen_by::FirstSmoothing{};
  if (stretches.empty()) return choice;
  Scan scan(motion, stretches, noise, pilot_bandwidth_s);
  std::vector<Errors> tried;
  for (double h = kLeastBandwidthSteps * motion.step_s;
       scan.has_directions() && 2.0 * kKernelMargin * h < scan.longest_s(); h *= kBandwidthRatio) {
    auto errors = scan.at(h);
    if (!errors) continue;
    // The bias grows with h; if its estimate falls again, this is due to v(t) and its noise.
    if (!tried.empty()) errors->biased = std::max(errors->biased, tried.back().biased);
    tried.push_back(*errors);
  }
  if (tried.empty()) return choice;
  const auto best = std::min_element(tried.begin(), tried.end(),
                                     [](const Errors& a, const Errors& b) { return a.square() < b.square(); });
  auto taken = best;
  while (taken->noise_share > kNoiseOfPoints && std::next(taken) != tried.end() &&
         std::next(taken)->bias_share <= kBiasAllowed && std::next(taken)->random <= kNoiseAllowed * best->random) {
    ++taken;
  }
  choice.bandwidth_s = taken->bandwidth_s;
  chosen_by::LinesRule found{best->bandwidth_s, {}};
  if (taken != best) found.raised = {taken->noise_share, taken->bias_share};
  choice.method = found;
  return choice;
}

}  // namespace glidelab::core
