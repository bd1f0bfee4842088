/// The numbers that a worksheet on a law asks for, from the glider's own a(v):
///
///     slopes  (a(v1) - a(0+)) / v1  and  (a(v2) - a(v1)) / (v2 - v1),  v2 = 2 v1;  both -K/m for viscous friction
///     jump    a(0-) - a(0+) = 2 mu g cos(alpha), mu that of dry friction near v = 0
#pragma once

#include <cstddef>

#include "teach/study/law_study.h"

namespace glidelab::teach {

struct LawAnswers {
  std::size_t curve = 0;              ///< index in study.curves of the curve that the questions are about
  double v1_m_s = 0.0, v2_m_s = 0.0;  ///< 1, 2 or 5 times a power of ten, and twice that
  double slope1_1_s = 0.0, slope2_1_s = 0.0;
  double jump_m_s2 = 0.0;
  double mu = 0.0;
  bool mu_varies = false;  ///< some dry friction depends on v, so that `mu` is that near v = 0 alone
  bool flat() const;       ///< no slope
  bool straight() const;   ///< the two slopes are equal within rounding
  bool jumps() const;      ///< by more than rounding
};

/// Of the curves with a part at v > 0, the first one with a terminal velocity is used, otherwise the last one.
/// std::logic_error if there is none.
LawAnswers answers_of(const LawStudy& study);

/// The curve with the side of v = 0 on which no motion of the study lies, half as far: without it the jump of a(v)
/// there cannot be read.
LawCurve in_both_directions(LawCurve curve);

}  // namespace glidelab::teach
