#include "core/motion/lines/line_law.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glidelab::core {
namespace {

constexpr int kMostSteps = 12;
constexpr double kBiasSettled = 1e-3;  // of the standard deviation of k and of a0
constexpr double kMostBias = 0.5;      // largest bias of k, as a fraction of k or of two of its standard deviations
constexpr double kDifference = 1e-3;   // relative step of the derivatives of the bias

/// Points of one stretch, and the measured positions within reach of their kernels.
struct Part {
  std::size_t first = 0, end = 0;  // of the input's points
  std::size_t from = 0, to = 0;    // of the positions
  double middle_s = 0.0;
};

std::vector<Part> parts_of(const LineInput& input) {
  std::vector<Part> parts;
  for (std::size_t j = 0; j < input.rows.size(); ++j) {
    const KernelRow& row = input.rows[j];
    const std::size_t to = row.first + row.weights->x.size();
    if (j == 0 || input.stretch[j] != input.stretch[j - 1]) parts.push_back({j, j, row.first, to, 0.0});
    parts.back().end = j + 1;
    parts.back().from = std::min(parts.back().from, row.first);
    parts.back().to = std::max(parts.back().to, to);
  }
  for (Part& part : parts) part.middle_s = 0.5 * (input.t_s[part.from] + input.t_s[part.to - 1]);
  return parts;
}

class OwnLaw {
 public:
  OwnLaw(const LineInput& input, const std::vector<double>& autocovariance) : input_(input), parts_(parts_of(input)) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    const KernelWeights* known = nullptr;
    double var_v = 0.0, cov_va = 0.0;
    const SeriesNoise noise{autocovariance, {}};
    for (std::size_t j = 0; j < input.rows.size(); ++j) {
      const Eigen::Vector2d design(-input.v_m_s[j], 1.0);
      normal += design * design.transpose();
      if (input.rows[j].weights.get() != known) {
        known = input.rows[j].weights.get();
        var_v = noise_covariance(0, known->v, 0, known->v, noise);
        cov_va = noise_covariance(0, known->v, 0, known->a, noise);
      }
      sum_var_v_ += var_v;
      sum_cov_va_ += cov_va;
    }
    inverse_ = normal.inverse();
  }

  /// The law's own smoothed v and a.
  struct Points {
    std::vector<double> v, a;
  };
  Points points(const Eigen::Vector2d& law) const {
    Points made;
    std::vector<double> phi(input_.t_s.size(), 0.0), psi = phi;
    for (const Part& part : parts_) {
      for (std::size_t i = part.from; i < part.to; ++i) {
        const LawFunctions at = law_functions(law[0], input_.t_s[i] - part.middle_s);
        phi[i] = at.phi;
        psi[i] = at.psi;
      }
      std::vector<SmoothedPoint> of_phi, of_psi;
      double norm = 0.0, product = 0.0;
      for (std::size_t j = part.first; j < part.end; ++j) {
        of_phi.push_back(weighted_sums(input_.rows[j], phi));
        of_psi.push_back(weighted_sums(input_.rows[j], psi));
        norm += of_phi.back().v_m_s * of_phi.back().v_m_s;
        product += of_phi.back().v_m_s * (input_.v_m_s[j] - law[1] * of_psi.back().v_m_s);
      }
      const double v0 = product / norm;
      for (std::size_t j = 0; j < of_phi.size(); ++j) {
        made.v.push_back(v0 * of_phi[j].v_m_s + law[1] * of_psi[j].v_m_s);
        made.a.push_back(v0 * of_phi[j].a_m_s2 + law[1] * of_psi[j].a_m_s2);
      }
    }
    return made;
  }

  Eigen::Vector2d bias(const Eigen::Vector2d& law) const {
    const Points made = points(law);
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d off = Eigen::Vector2d::Zero();
    for (std::size_t j = 0; j < made.v.size(); ++j) {
      const Eigen::Vector2d design(-made.v[j], 1.0);
      normal += design * design.transpose();
      off += design * (made.a[j] - design.dot(law));
    }
    return normal.inverse() * off - inverse_ * Eigen::Vector2d(law[0] * sum_var_v_ + sum_cov_va_, 0.0);
  }

  Eigen::Matrix2d slope(const Eigen::Vector2d& law) const {
    Eigen::Matrix2d slope;
    for (int i = 0; i < 2; ++i) {
      const double step = kDifference * (std::abs(law[i]) + 1e-3);  // 1e-3: in 1/s or m/s², if the law's value is 0
      Eigen::Vector2d above = law, below = law;
      above[i] += step;
      below[i] -= step;
      slope.col(i) = (bias(above) - bias(below)) / (2.0 * step);
    }
    return slope;
  }

 private:
  const LineInput& input_;
  std::vector<Part> parts_;
  Eigen::Matrix2d inverse_;
  double sum_var_v_ = 0.0, sum_cov_va_ = 0.0;
};

}  // namespace

std::optional<LawBias> law_bias(const LineInput& input, const LineFit& line,
                                const std::vector<double>& autocovariance) {
  if (input.forced) return {};
  const auto plain = fit_line(line.direction, input, autocovariance, 0.0, Misfit::ignored);
  if (!plain) return {};
  const OwnLaw own(input, autocovariance);
  const Eigen::Vector2d as_fitted(line.k_over_m_1_s.value, line.a0_m_s2.value);
  const Eigen::Vector2d sd(std::sqrt(plain->parts.var_k), std::sqrt(plain->parts.var_a0));
  Eigen::Vector2d law = as_fitted, bias = Eigen::Vector2d::Zero();
  bool settled = false;
  for (int step = 0; step < kMostSteps && !settled; ++step) {
    bias = own.bias(law);
    const Eigen::Vector2d next = as_fitted - bias;
    if (!next.allFinite()) return {};
    settled =
        ((next - law).array().abs() <= kBiasSettled * sd.array() + 1e-12).all();  // 1e-12: positions without noise
    law = next;
  }
  if (!settled || !(std::abs(bias[0]) <= kMostBias * std::max(std::abs(law[0]), 2.0 * sd[0]))) return {};

  const OwnLaw::Points made = own.points(law);
  std::vector<double> residual;
  for (std::size_t j = 0; j < made.v.size(); ++j) {
    residual.push_back(input.a_m_s2[j] - made.a[j] + law[0] * (input.v_m_s[j] - made.v[j]));
  }
  const Scatter scatter = scatter_of(input, residual, law[0], autocovariance);
  if (scatter.significant()) return {};
  Eigen::Matrix2d covariance;
  covariance << plain->parts.var_k, plain->parts.cov, plain->parts.cov, plain->parts.var_a0;
  double degrees = std::numeric_limits<double>::infinity();
  if (line.parts.jackknife) {
    covariance << line.parts.var_k, line.parts.cov, line.parts.cov, line.parts.var_a0;
    degrees = line.parts.degrees;
  }
  const Eigen::Matrix2d gain = (Eigen::Matrix2d::Identity() + own.slope(law)).inverse();
  const Eigen::Matrix2d left = gain * covariance * gain.transpose();
  return LawBias{{bias[0], bias[1]}, left(0, 0), left(0, 1), left(1, 1), degrees};
}

LineFit without_law_bias(LineFit line) {
  if (!line.parts.law) return line;
  const LawBias law = *line.parts.law;
  line.k_over_m_1_s.value -= law.shift.k;
  line.a0_m_s2.value -= law.shift.a0;
  line.parts.var_k = law.var_k;
  line.parts.cov = law.cov;
  line.parts.var_a0 = law.var_a0;
  line.parts.degrees = law.degrees;
  line.parts.law.reset();
  complete_line(line);
  return line;
}

}  // namespace glidelab::core
