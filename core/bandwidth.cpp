#include "core/bandwidth.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/line_fit.h"
#include "core/line_input.h"
#include "core/stretch_points.h"

namespace glidelab::core {
namespace {

constexpr double kLeastSteps = 1.2;   // of the time step: a kernel narrower than that holds fewer than five points
constexpr double kRatio = 1.1;        // from one bandwidth of the grid to the next
constexpr double kQuiet = 0.0125;     // noise of a over its standard deviation along the line
constexpr double kShareOfTime = 0.2;  // of the free time that a direction needs to have a say
constexpr double kPointsPerBandwidth = 3.0;  // points closer together say the same

double time_of(const Motion& motion, const FreeStretch& stretch) {
  return motion.t_s[stretch.first + stretch.count - 1] - motion.t_s[stretch.first];
}

struct Errors {
  double line = std::numeric_limits<double>::infinity();
  double point = std::numeric_limits<double>::infinity();
  double noise_share = std::numeric_limits<double>::infinity();  // of the noisier direction
};

/// Mean over 0 <= v <= top of (d a0 - v d k)^2, for the second moments of (d k, d a0).
double mean_square(const LineFit& line, double top) {
  const LineUncertainty& parts = line.parts;
  const double kk = parts.var_k + parts.smoothing_k * parts.smoothing_k;
  const double aa = parts.var_a0 + parts.smoothing_a0 * parts.smoothing_a0;
  const double ka = parts.cov + parts.smoothing_k * parts.smoothing_a0;
  return aa - line.direction * top * ka + top * top / 3.0 * kk;
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

  Errors at(double bandwidth_s) {
    const auto stride =
        static_cast<std::size_t>(std::max(1.0, std::floor(bandwidth_s / (kPointsPerBandwidth * motion_.step_s))));
    const std::vector<StretchPoint> points = smooth_stretches(motion_, stretches_, bandwidth_s, stride);
    const std::vector<double> bias = smoothing_bias(motion_, stretches_, law_, points);
    RowVariance variance(noise_.autocovariance);
    Errors errors{0.0, 0.0, 0.0};
    double count = 0.0;
    for (const int direction : directions_) {
      const LineInput input = line_input(motion_, points, bias, direction, 0.0, 0.0);
      const auto line = fit_line(direction, input, noise_.autocovariance, 0.0);
      if (!line) return {};
      double& top = top_speed_[direction > 0];
      top = std::max({top, std::abs(line->from_v_m_s), std::abs(line->to_v_m_s)});
      errors.line += mean_square(*line, top);
      double noise = 0.0, v = 0.0, vv = 0.0;
      for (std::size_t j = 0; j < input.rows.size(); ++j) {
        noise += variance.of_a(input.rows[j]);
        errors.point += variance.of_a(input.rows[j]) + input.bias_a_m_s2[j] * input.bias_a_m_s2[j];
        v += input.v_m_s[j];
        vv += input.v_m_s[j] * input.v_m_s[j];
      }
      const auto n = static_cast<double>(input.rows.size());
      const double spread = line->k_over_m_1_s.value * std::sqrt(std::max(0.0, vv / n - v * v / (n * n)));
      errors.noise_share = std::max(errors.noise_share, std::sqrt(noise / n) / std::max(std::abs(spread), 1e-300));
      count += n;
    }
    errors.point /= count;
    return errors;
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

}  // namespace

namespace {

/// Least squares of y in powers of v / top, with the sum of squares that is left.
struct Polynomial {
  Eigen::VectorXd coefficient;
  double top = 1.0;
  double squares = 0.0;
  double at(double v) const {
    double value = 0.0;
    for (Eigen::Index i = coefficient.size(); i-- > 0;) value = value * (v / top) + coefficient[i];
    return value;
  }
};

Polynomial fit_polynomial(const std::vector<double>& v, const std::vector<double>& y, const std::vector<double>& weight,
                          Eigen::Index coefficients, double top) {
  const auto n = static_cast<Eigen::Index>(v.size());
  Eigen::MatrixXd design(n, coefficients);
  Eigen::VectorXd right(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const auto j = static_cast<std::size_t>(r);
    const double root = std::sqrt(weight[j]);
    for (Eigen::Index c = 0; c < coefficients; ++c) design(r, c) = root * std::pow(v[j] / top, static_cast<double>(c));
    right[r] = root * y[j];
  }
  Polynomial fit{design.colPivHouseholderQr().solve(right), top, 0.0};
  fit.squares = (design * fit.coefficient - right).squaredNorm();
  return fit;
}

/// The law of one direction; nothing where it has no smoothed points.
std::optional<Polynomial> law_of_direction(const Motion& motion, const std::vector<StretchPoint>& points, int direction,
                                           double bandwidth_s) {
  std::vector<double> v, y, weight;
  RowVariance variance({1.0});
  for (const bool only_used : {true, false}) {
    v.clear();
    y.clear();
    weight.clear();
    for (const StretchPoint& point : points) {
      if (point.direction != direction || !point.smoothed) continue;
      if (only_used && point.left_out != LeftOut::used) continue;
      v.push_back(point.x.v_m_s);
      y.push_back(point.y.a_m_s2);
      weight.push_back(1.0 / variance.of_a(*point.row));
    }
    if (v.size() >= 8) break;
  }
  if (v.empty()) return {};
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  const double top = std::max({std::abs(*low), std::abs(*high), 1e-12});
  if (*high - *low < 0.05 * top || v.size() < 8) return fit_polynomial(v, y, weight, 1, top);
  const Polynomial line = fit_polynomial(v, y, weight, 2, top);
  const Polynomial parabola = fit_polynomial(v, y, weight, 3, top);
  // Points closer than two bandwidths are not independent. A parabola that is not significant only adds noise.
  const double independent = static_cast<double>(v.size()) * motion.step_s / (2.0 * bandwidth_s);
  const bool curved =
      independent > 4.0 && (line.squares - parabola.squares) * (independent - 3.0) > 9.0 * parabola.squares;
  return curved ? parabola : line;
}

}  // namespace

std::vector<double> pilot_law(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
  const std::vector<StretchPoint> points = smooth_stretches(motion, stretches, bandwidth_s);
  std::vector<double> law(motion.t_s.size(), 0.0);
  for (const int direction : {-1, 1}) {
    const auto of_v = law_of_direction(motion, points, direction, bandwidth_s);
    if (!of_v) continue;
    for (const StretchPoint& point : points) {
      if (point.direction == direction && point.smoothed) law[point.point] = of_v->at(point.x.v_m_s);
    }
  }
  return law;
}

double law_bandwidth(const Motion& motion, double pilot_bandwidth_s) {
  return std::max(0.5 * pilot_bandwidth_s, kLeastSteps * motion.step_s);
}

BandwidthChoice choose_bandwidth(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                 const PositionNoise& noise, double pilot_bandwidth_s) {
  BandwidthChoice choice;
  choice.bandwidth_s = pilot_bandwidth_s;
  choice.method = "that of the first smoothing: no bandwidth gives a line";
  if (stretches.empty()) return choice;
  Scan scan(motion, stretches, noise, pilot_bandwidth_s);
  Errors best;
  double quiet = std::numeric_limits<double>::infinity(), previous_share = 0.0, previous_h = 0.0;
  for (double h = kLeastSteps * motion.step_s; scan.has_directions() && 2.0 * kKernelMargin * h < scan.longest_s();
       h *= kRatio) {
    const Errors errors = scan.at(h);
    if (!std::isfinite(errors.line)) continue;
    if (errors.line < best.line) {
      best.line = errors.line;
      choice.line_s = h;
    }
    if (errors.point < best.point) {
      best.point = errors.point;
      choice.point_s = h;
    }
    if (!std::isfinite(quiet) && errors.noise_share <= kQuiet) {
      // Between the grid's points the share is a power of h.
      const double power =
          previous_h > 0.0 ? std::log(kQuiet / previous_share) / std::log(errors.noise_share / previous_share) : 1.0;
      quiet = previous_h > 0.0 ? previous_h * std::pow(h / previous_h, power) : h;
    }
    previous_share = errors.noise_share;
    previous_h = h;
  }
  if (choice.line_s == 0.0) return choice;
  choice.quiet_s = quiet;
  choice.bandwidth_s = std::max(choice.line_s, std::min(quiet, choice.point_s));
  const char* reason = choice.bandwidth_s == choice.line_s    ? "least mean squared error of the lines"
                       : choice.bandwidth_s == choice.point_s ? "least mean squared error of the points"
                                                              : "noise of a at 1.25 % of its spread";
  choice.method =
      fmt::format("{} (lines: {:.1f} ms, points: {:.1f} ms)", reason, 1e3 * choice.line_s, 1e3 * choice.point_s);
  return choice;
}

}  // namespace glidelab::core
