/// How well the acceleration of gravity of an experiment is known.
#pragma once

#include <optional>

namespace glidelab::core {

/// The standard value, which is taken where nothing is stated. It is that of no particular place.
inline constexpr double kStandardGravity_m_s2 = 9.80665;

/// Standard deviation of the local gravity about the standard value. At sea level the normal gravity lies between
/// 9.780 m/s² (equator) and 9.832 m/s² (poles) (Somigliana's formula, GRS80); evenly spread over that range it has a
/// standard deviation of 0.052/sqrt(12) = 0.015 m/s².
inline constexpr double kLocalGravity_sd_m_s2 = 0.015;

/// Standard deviation of a value of gravity whose uncertainty is not stated, in m/s². The standard value and 9.81,
/// which is written everywhere, say nothing of the place, so they have the spread over the Earth. Any other value is
/// that of the place, rounded to its last digit: half a unit of it over sqrt(3), but at most the spread over the
/// Earth. 9.82 has 0.0029, 9.8123 has 0.000029, and 9.8 the spread.
double gravity_sd_m_s2(double gravity_m_s2);

/// A value of gravity with the standard deviation that alpha and mu take from it.
struct Gravity {
  Gravity(double value_m_s2, double standard_deviation_m_s2 = 0.0)  // NOLINT: a number alone is exact
      : m_s2(value_m_s2), sd_m_s2(standard_deviation_m_s2) {}
  double m_s2;
  double sd_m_s2;
};

/// The one rule for gravity, of folders, files and arrays: as stated, otherwise the standard value; with the standard
/// deviation as stated, otherwise gravity_sd_m_s2().
Gravity stated_gravity(std::optional<double> m_s2, std::optional<double> sd_m_s2 = {});

}  // namespace glidelab::core
