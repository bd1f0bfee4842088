/// The lines a = a0 - (K/m) v that an analysis fitted, one for each direction of motion at most.
#pragma once

#include <algorithm>
#include <vector>

#include "core/result/results.h"

namespace glidelab::report {

/// The line for the sign of v (or of a direction, ±1); null if there is none, and at v = 0.
inline const core::LineFit* line_of(const std::vector<core::LineFit>& lines, double v_m_s) {
  const auto found =
      std::find_if(lines.begin(), lines.end(), [&](const core::LineFit& line) { return line.direction * v_m_s > 0.0; });
  return found == lines.end() ? nullptr : &*found;
}

/// a on the line, in m/s².
inline double line_at(const core::LineFit& line, double v_m_s) {
  return line.a0_m_s2.value - line.k_over_m_1_s.value * v_m_s;
}

}  // namespace glidelab::report
