#include "core/result/results.h"

#include <cassert>
#include <cmath>

#include "base/math/angles.h"
#include "core/experiment/clip_setup.h"

namespace glidelab::core {

std::optional<SlowFall> slow_fall(const ConfigurationResult& configuration, double gravity_m_s2) {
  constexpr double kOfGravity = 1.0 / 3.0, kClear = 3.0;  // standard deviations
  const double incline_rad = configuration.incline_deg * base::kRadPerDegree, sine = std::sin(incline_rad);
  if (!is_fall(incline_rad) || !(gravity_m_s2 > 0.0)) return {};
  for (const LineFit& line : configuration.lines) {
    if (!(line.direction * sine > 0.0)) continue;  // upwards
    Estimate a0 = line.a0_m_s2;
    if (sine < 0.0) a0.value = -a0.value;
    if (a0.value + kClear * a0.sd < kOfGravity * gravity_m_s2 * std::abs(sine)) return SlowFall{a0, gravity_m_s2};
  }
  return {};
}

std::string describe(LeftOut reason) {
  switch (reason) {
    case LeftOut::used:
      return "used";
    case LeftOut::before_start:
      return "before the stated start";
    case LeftOut::after_end:
      return "after the stated end";
    case LeftOut::hand:
      return "hand";
    case LeftOut::rest:
      return "at rest";
    case LeftOut::stop:
      return "stop";
    case LeftOut::kernel_end:
      return "kernel over an end";
    case LeftOut::kernel_reversal:
      return "kernel over a reversal";
    case LeftOut::kernel_gap:
      return "kernel over a gap";
    case LeftOut::no_marker:
      return "no marker";
    case LeftOut::outlier:
      return "outlier";
    case LeftOut::short_stretch:
      return "short stretch";
  }
  assert(false);
  return "";
}

}  // namespace glidelab::core
