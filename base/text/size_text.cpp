#include "base/text/size_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/text/number_text.h"

namespace glidelab::base {
namespace {

constexpr double kBelow = 0.1;  // of a unit: then a smaller one
constexpr std::array<std::string_view, 4> kPrefixed = {"m", "s", "N", "m/s²"};
constexpr std::array<std::string_view, 4> kPrefixes = {"", "m", "µ", "n"};

struct Scaled {
  double factor = 1.0;
  std::string unit;  ///< with the space before it
};

Scaled scaled(double size, std::string_view unit) {
  Scaled of{1.0, unit.empty() ? std::string() : fmt::format(" {}", unit)};
  if (std::find(kPrefixed.begin(), kPrefixed.end(), unit) == kPrefixed.end()) return of;
  if (!std::isfinite(size) || size == 0.0) return of;
  std::size_t prefix = 0;
  while (prefix + 1 < kPrefixes.size() && std::abs(size) * of.factor < kBelow) {
    of.factor *= 1000.0;
    ++prefix;
  }
  of.unit = fmt::format(" {}{}", kPrefixes[prefix], unit);
  return of;
}

}  // namespace

std::string size_text(double value, int digits, std::string_view unit) {
  const Scaled of = scaled(value, unit);
  return number_text(value * of.factor, digits) + of.unit;
}

std::string size_and_sd_text(double value, double sd, std::string_view unit) {
  const Scaled of = scaled(std::abs(value) > sd || !std::isfinite(sd) ? value : sd, unit);
  if (!(sd > 0.0) || !std::isfinite(sd)) return value_text(value * of.factor, sd) + of.unit;
  return value_and_sd_text(value * of.factor, sd * of.factor) + of.unit;
}

NamedUnit name_and_unit(std::string_view key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kUnits = {{{"_s2_m_s2", "m/s² for each 1/s²"},
                                                                                     {"_kg_m", "kg/m"},
                                                                                     {"_1_m2", "1/m²"},
                                                                                     {"_1_m", "1/m"},
                                                                                     {"_n_s_m", "N s/m"},
                                                                                     {"_n_m", "N/m"},
                                                                                     {"_m_s2", "m/s²"},
                                                                                     {"_m_s", "m/s"},
                                                                                     {"_kg", "kg"},
                                                                                     {"_hz", "Hz"},
                                                                                     {"_px", "px"},
                                                                                     {"_n", "N"},
                                                                                     {"_m", "m"},
                                                                                     {"_s", "s"}}};
  for (const auto& [ending, unit] : kUnits) {
    if (key.ends_with(ending)) {
      return {std::string(key.substr(0, key.size() - ending.size())), std::string(unit)};
    }
  }
  return {std::string(key), ""};
}

}  // namespace glidelab::base
