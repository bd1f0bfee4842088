/// Numbers and quantities as a person reads them: with no more digits than their uncertainty supports, in convenient
/// units.
#pragma once

#include <string>
#include <string_view>

namespace glidelab::base {

/// A value with `digits` significant digits, "0.00712", "2.763", "410", "0.0000181"; a power of ten ("7.3e+08") only
/// below 1e-7 and from 1e6 on; "–" for a value that is not finite.
std::string number_text(double value, int digits = 4);

/// The same with trailing zeros, for columns of numbers of equal precision: "1.10" below "1.04", "10.0"; "0".
std::string digits_text(double value, int digits);

/// The value, with as many decimals as its standard deviation has when given to two significant digits: (2.77913,
/// 0.0062) gives "2.7791". Without a positive finite sd, six significant digits.
std::string value_text(double value, double sd);

/// The standard deviation with two significant digits and the same decimals.
std::string sd_text(double sd);

/// "2.7791 ± 0.0062".
std::string value_and_sd_text(double value, double sd);

/// An error with its sign and the decimals of the sd: "+0.0031"; without a sign if it rounds to zero: "0.0000".
std::string error_text(double error, double sd);

/// Writes the power of ten of a formatted number in typographic form: "1.957e-05" is "1.957·10⁻⁵"; other texts stay.
std::string with_raised_power(const std::string& number);

/// A gain in log likelihood or evidence, with its sign: "+3.2", "-0.4", above a thousand "+139521", above a million
/// "+1.395·10¹²".
std::string gain_text(double gain);

/// R² with enough decimals to tell it from 1: "0.99993".
std::string r2_text(double r2);

/// A quantity in convenient units, with `digits` significant digits: -0.0036 m is -3.6 mm, 3.067e-5 s is 30.67 µs.
/// Metres, seconds, newtons and m/s² get a prefix (m, µ, n) if the value is below a tenth of the unit; other units
/// stay.
std::string size_text(double value, int digits, std::string_view unit);

/// "30.67 ± 0.34 µs", likewise; without a positive finite sd the value alone, with as many digits as value_text()
/// gives.
std::string size_and_sd_text(double value, double sd, std::string_view unit);

/// A key of a file in readable form: "c_kg_m" is c in kg/m. No unit if the key names none.
struct NamedUnit {
  std::string name, unit;
};
NamedUnit name_and_unit(std::string_view key);

/// The digits 0 to 9, independent of the locale.
constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace glidelab::base
