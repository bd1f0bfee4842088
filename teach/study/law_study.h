/// The cases by which friction is taught: motions of a scenario, and the curve a(v) on which each of them runs.
///
/// a(v) = (m g sin(alpha) + forces(v, sign v)) / m for v < 0 and v > 0 (the paper's figures 1 to 3), with its
/// equilibria (teach/study/equilibria.h).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "teach/study/equilibria.h"

namespace glidelab::teach {

struct LawMotion {
  std::string clip;
  std::string configuration;
  std::vector<double> t_s, x_m, v_m_s, a_m_s2;  ///< kFramesPerSecond a second
};

struct LawCurve {
  std::string configuration;
  double incline_deg = 0.0;
  std::vector<double> up_v_m_s, up_a_m_s2;      ///< v from the lowest of the motions to 0
  std::vector<double> down_v_m_s, down_a_m_s2;  ///< v from 0 to the highest, or to v_lim if that is more
  std::vector<Equilibrium> equilibria;          ///< on that piece of the curve, v rising
  std::vector<std::size_t> motions;             ///< on this curve
};

struct LawStudy {
  std::string name;
  std::string text;  ///< the comment at the head of the scenario's file
  std::vector<LawCurve> curves;
  std::vector<LawMotion> motions;
  /// Where there are just two motions, of one length and one on each curve: the largest difference of x, and of a at
  /// the same v.
  std::optional<double> x_apart_m, a_apart_m_s2;
};

inline constexpr double kFramesPerSecond = 50.0;

/// InputError for what is wrong with the scenario.
LawStudy study_law(const std::filesystem::path& scenario);

}  // namespace glidelab::teach
