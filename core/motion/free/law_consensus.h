/// The line a = a0 - k v that most points of one direction agree with, regardless of the outliers.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace glidelab::core {

/// Points of one direction in the order of time; `sd` is the standard deviation of a by the noise of the positions.
struct LawPoints {
  std::vector<double> v_m_s;
  std::vector<double> a_m_s2;
  std::vector<double> sd_m_s2;
};

struct ConsensusLine {
  double a0_m_s2 = 0.0;
  double k_1_s = 0.0;
  double size_m_s2 = 0.0;  ///< the 90 % quantile of |a0 - k v| over its points
  double scatter = 1.0;    ///< robust standard deviation of its points about it, in units of their sd; at least 1
  double at(double v_m_s) const { return a0_m_s2 - k_1_s * v_m_s; }
  /// What a point may lie off without being counted out.
  double tolerance(double sd_m_s2) const;
};

/// Candidates are the least-squares lines through parts of the points that follow each other; the one with the most
/// points within its tolerance wins and is refitted to them. Nothing for fewer than six points.
std::optional<ConsensusLine> find_consensus(const LawPoints& points);

}  // namespace glidelab::core
