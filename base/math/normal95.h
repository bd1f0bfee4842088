/// The normal distribution's 95 %.
#pragma once

namespace glidelab::base {

/// Standard deviations to either side that hold 95 % of a normal distribution: the quantile of 0.975.
inline constexpr double kNormal95 = 1.959963984540054;

}  // namespace glidelab::base
