#include "base/text/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace glidelab::base {
namespace {

constexpr int kMostDecimals = 9;  // beyond that a power of ten reads better
constexpr int kLeastPlainPower = -7, kMostPlainPower = 5;

/// Decimals that show two significant digits of `sd` (after rounding: 0.0996 becomes 0.10).
int decimals_of(double sd) {
  const int exponent = static_cast<int>(std::floor(std::log10(sd * (1.0 + 0.5e-2))));
  return std::max(0, 1 - exponent);
}

bool usable(double sd) {
  return std::isfinite(2.0 * sd) && sd > 0.0 && decimals_of(sd) <= kMostDecimals;  // rounded up it is finite too
}

/// "4.1e+02" as 410, "1.80e-05" as 0.0000180, if these are short.
std::string plain(const std::string& text) {
  const std::size_t power = text.find('e');
  if (power == std::string::npos) return text;
  const int exponent = std::stoi(text.substr(power + 1));
  if (exponent < kLeastPlainPower || exponent > kMostPlainPower) return text;
  // Shifts the decimal point of the mantissa by the power of ten: 4.1e+02 becomes 410, 1.8e-05 becomes 0.000018.
  const std::size_t point = text.find('.');
  const int behind_point = point < power ? static_cast<int>(power - point) - 1 : 0;
  return fmt::format("{:.{}f}", std::stod(text), std::max(0, behind_point - exponent));
}

}  // namespace

std::string number_text(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  return value == 0.0 ? "0" : plain(fmt::format("{:.{}g}", value, digits));
}

std::string digits_text(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const std::string text = fmt::format("{:.{}e}", value, digits - 1);  // rounded, so that 9.996 gets the right power of
                                                                       // ten
  const int exponent = std::stoi(text.substr(text.find('e') + 1));
  if (exponent < kLeastPlainPower || exponent > kMostPlainPower) return text;
  return fmt::format("{:.{}f}", std::stod(text), std::max(0, digits - 1 - exponent));
}

std::string value_text(double value, double sd) {
  if (!std::isfinite(value) || !usable(sd)) return number_text(value, 6);
  const std::string text = fmt::format("{:.{}f}", value, decimals_of(sd));
  return text.starts_with('-') && text.find_first_of("123456789") == std::string::npos ? text.substr(1) : text;
}

std::string sd_text(double sd) {
  if (!usable(sd)) return number_text(sd, 2);
  return fmt::format("{:.{}f}", sd, decimals_of(sd));
}

std::string value_and_sd_text(double value, double sd) {
  return fmt::format("{} ± {}", value_text(value, sd), sd_text(sd));
}

std::string error_text(double error, double sd) {
  if (!std::isfinite(error)) return number_text(error);
  if (!usable(sd)) return fmt::format("{:+.3g}", error);
  const std::string text = fmt::format("{:+.{}f}", error, decimals_of(sd));
  return text.find_first_of("123456789") == std::string::npos ? text.substr(1) : text;
}

std::string with_raised_power(const std::string& number) {
  const std::size_t power = number.find('e');
  if (power == std::string::npos) return number;
  constexpr std::array<const char*, 10> kRaised = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string raised;
  for (const char digit : std::to_string(std::stoi(number.substr(power + 1)))) {
    raised += digit == '-' ? "⁻" : kRaised[static_cast<std::size_t>(digit - '0')];
  }
  return number.substr(0, power) + "·10" + raised;
}

std::string gain_text(double gain) {
  constexpr double kDecimalsBelow = 1e3, kDigitsBelow = 1e6;
  if (!std::isfinite(gain)) return number_text(gain);
  if (std::abs(gain) < kDecimalsBelow) return fmt::format("{:+.1f}", gain);
  if (std::abs(gain) < kDigitsBelow) return fmt::format("{:+.0f}", gain);
  return with_raised_power(fmt::format("{:+.3e}", gain));
}

std::string r2_text(double r2) {
  if (!std::isfinite(r2)) return "–";
  // It is never rounded up to 1: 0.99999996 keeps its digits.
  for (int decimals = 5; decimals < kMostDecimals; ++decimals) {
    std::string text = fmt::format("{:.{}f}", r2, decimals);
    if (r2 >= 1.0 || !text.starts_with("1.")) return text;
  }
  return fmt::format("{:.{}f}", r2, kMostDecimals);
}

namespace {

constexpr double kBelow = 0.1;  // fraction of a unit below which a smaller unit is used
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
