#include "core/analysis/joint_line.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/line_sums.h"
#include "core/motion/lines/law_bias.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"

namespace glidelab::core {
namespace {

Eigen::Matrix2d random_part(const LineUncertainty& parts) {
  Eigen::Matrix2d covariance;
  covariance << parts.var_k, parts.cov, parts.cov, parts.var_a0;
  return covariance;
}

/// One direction of one clip: the weight of its line (the moments of its points, or the line's inverse covariance), and
/// the line.
struct Part {
  LineFit line;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  std::vector<double> v, a;
};

std::vector<Part> parts_of(const std::vector<MemberClip>& members, int direction, LineMethod lines, LawBiasIs bias) {
  std::vector<Part> parts;
  for (const MemberClip& member : members) {
    for (const LineFit& line : member.clip->segments) {
      if (line.direction != direction) continue;
      Part part;
      part.line = bias == LawBiasIs::kept ? line : without_law_bias(line);
      for (const MotionPoint& point : member.clip->motion) {
        if (point.left_out != LeftOut::used || (point.v_m_s > 0.0 ? 1 : -1) != direction) continue;
        part.v.push_back(point.v_m_s);
        part.a.push_back(point.a_m_s2 - point.force_n / member.setup->mass_kg);
        const Eigen::Vector2d design(-point.v_m_s, 1.0);
        part.normal += design * design.transpose();
      }
      const Eigen::Matrix2d random = random_part(line.parts);
      if (lines == LineMethod::generalised && random.determinant() > 0.0) part.normal = random.inverse();
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

/// How much more the clips' own lines scatter about the joint one than their uncertainty allows: chi^2 per degree of
/// freedom, where that is more than chance makes it. (Widening by every chi^2 above 1 makes two right lines'
/// standard deviation 17 % too large on average.)
double excess_scatter(const std::vector<Part>& parts, const Eigen::Vector2d& joint) {
  if (parts.size() < 2) return 1.0;
  double chi2 = 0.0;
  for (const Part& part : parts) {
    Eigen::Matrix2d covariance = random_part(part.line.parts);
    for (const LineShift& shift : shared_shifts(part.line)) {
      const Eigen::Vector2d both(shift.k, shift.a0);
      covariance += both * both.transpose();
    }
    if (!(covariance.determinant() > 0.0)) return 1.0;
    const Eigen::Vector2d off = Eigen::Vector2d(part.line.k_over_m_1_s.value, part.line.a0_m_s2.value) - joint;
    chi2 += off.dot(covariance.inverse() * off);
  }
  const double freedom = 2.0 * static_cast<double>(parts.size() - 1);
  return chi2 > freedom * chi2_ratio_limit(freedom) ? chi2 / freedom : 1.0;
}

double squared_correlation(const std::vector<Part>& parts) {
  PairCorrelation correlation;
  for (const Part& part : parts) {
    for (std::size_t i = 0; i < part.v.size(); ++i) correlation.add(part.v[i], part.a[i]);
  }
  return correlation.squared();
}

/// Least squares through the points of all parts; ordinary: every point with the same weight. The parts' noise is
/// independent: cov = N^-1 (sum N_c cov_c N_c) N^-1 with the normal matrices N_c of the parts.
LineFit join(const std::vector<Part>& parts, int direction) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero(), random = Eigen::Matrix2d::Zero();
  Eigen::Vector2d line = Eigen::Vector2d::Zero(), smoothing = line, mass = line;
  std::vector<Eigen::Vector2d> calibration;
  double var_a0 = 0.0, var2_per_degree = 0.0;
  LineFit joint;
  joint.direction = direction;
  joint.from_v_m_s = parts.front().line.from_v_m_s;
  joint.to_v_m_s = parts.front().line.to_v_m_s;
  for (const Part& part : parts) {
    const LineUncertainty& of = part.line.parts;
    normal += part.normal;
    line += part.normal * Eigen::Vector2d(part.line.k_over_m_1_s.value, part.line.a0_m_s2.value);
    random += part.normal * random_part(of) * part.normal;
    const LineShift law = of.law ? of.law->shift : LineShift{};
    smoothing += part.normal * Eigen::Vector2d(of.smoothing_k + law.k, of.smoothing_a0 + law.a0);
    mass += part.normal * Eigen::Vector2d(of.mass_k, of.mass_a0);
    const double share = part.normal(1, 1) * part.normal(1, 1) * of.var_a0;
    var_a0 += share;
    var2_per_degree += share * share / of.degrees;
    joint.points += part.line.points;
    joint.from_v_m_s = std::min(joint.from_v_m_s, part.line.from_v_m_s);
    joint.to_v_m_s = std::max(joint.to_v_m_s, part.line.to_v_m_s);
    joint.parts.scale_relative = std::max(joint.parts.scale_relative, of.scale_relative);
    if (calibration.size() < of.calibration.size()) calibration.resize(of.calibration.size(), Eigen::Vector2d::Zero());
    for (std::size_t mode = 0; mode < of.calibration.size(); ++mode) {
      calibration[mode] += part.normal * Eigen::Vector2d(of.calibration[mode].k, of.calibration[mode].a0);
    }
  }
  const Eigen::Matrix2d inverse = normal.inverse();
  const Eigen::Vector2d solution = inverse * line;
  const Eigen::Matrix2d covariance = inverse * random * inverse * excess_scatter(parts, solution);
  joint.k_over_m_1_s.value = solution[0];
  joint.a0_m_s2.value = solution[1];
  joint.parts.var_k = covariance(0, 0);
  joint.parts.var_a0 = covariance(1, 1);
  joint.parts.cov = covariance(0, 1);
  // Welch and Satterthwaite: degrees of freedom of a sum of variances.
  joint.parts.degrees = var2_per_degree > 0.0 ? std::max(1.0, var_a0 * var_a0 / var2_per_degree)
                                              : std::numeric_limits<double>::infinity();
  joint.parts.smoothing_k = (inverse * smoothing)[0];
  joint.parts.smoothing_a0 = (inverse * smoothing)[1];
  joint.parts.mass_k = (inverse * mass)[0];
  joint.parts.mass_a0 = (inverse * mass)[1];
  for (const Eigen::Vector2d& sum : calibration) {
    const Eigen::Vector2d shift = inverse * sum;
    joint.parts.calibration.push_back({shift[0], shift[1]});
  }
  joint.r2 = squared_correlation(parts);
  complete_line(joint);
  return joint;
}

}  // namespace

std::vector<LineFit> join_lines(const std::vector<MemberClip>& members, LineMethod lines, LawBiasIs bias) {
  std::vector<LineFit> joined;
  for (const int direction : {-1, 1}) {
    const std::vector<Part> parts = parts_of(members, direction, lines, bias);
    if (!parts.empty()) joined.push_back(join(parts, direction));
  }
  return joined;
}

}  // namespace glidelab::core
