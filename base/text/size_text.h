/// Sizes in the units that people use: -0.0036 m is -3.6 mm, 3.067e-5 s is 30.67 µs.
#pragma once

#include <string>
#include <string_view>

namespace glidelab::base {

/// With `digits` significant digits, and a thousandth, a millionth … of metres, seconds, newtons and m/s² where the
/// value is below a tenth of them; other units stay.
std::string size_text(double value, int digits, std::string_view unit);

/// "30.67 ± 0.34 µs", likewise; without a positive finite sd the value alone, with as many digits as value_text() has.
std::string size_and_sd_text(double value, double sd, std::string_view unit);

/// A key of a file as a person reads it: "c_kg_m" is c in kg/m. No unit where the key names none.
struct NamedUnit {
  std::string name, unit;
};
NamedUnit name_and_unit(std::string_view key);

}  // namespace glidelab::base
