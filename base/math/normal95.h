/// The 95 % interval of the normal distribution.
#pragma once

namespace glidelab::base {

/// Half its width in standard deviations: the 0.975 quantile.
inline constexpr double kNormal95 = 1.959963984540054;

}  // namespace glidelab::base
