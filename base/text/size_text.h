/// Quantities in convenient units: -0.0036 m is -3.6 mm, 3.067e-5 s is 30.67 µs.
#pragma once

#include <string>
#include <string_view>

namespace glidelab::base {

/// With `digits` significant digits. Metres, seconds, newtons and m/s² get a prefix (m, µ, n) if the value is below a
/// tenth of the unit; other units stay.
std::string size_text(double value, int digits, std::string_view unit);

/// "30.67 ± 0.34 µs", likewise; without a positive finite sd the value alone, with as many digits as value_text() has.
std::string size_and_sd_text(double value, double sd, std::string_view unit);

/// A key of a file in readable form: "c_kg_m" is c in kg/m. No unit if the key names none.
struct NamedUnit {
  std::string name, unit;
};
NamedUnit name_and_unit(std::string_view key);

}  // namespace glidelab::base
