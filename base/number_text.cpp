#include "base/number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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
  return std::isfinite(sd) && sd > 0.0 && decimals_of(sd) <= kMostDecimals;
}

}  // namespace

std::string number_text(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const std::string text = fmt::format("{:.{}g}", value, digits);
  const std::size_t power = text.find('e');
  if (power == std::string::npos) return text;
  const int exponent = std::stoi(text.substr(power + 1));
  if (exponent < kLeastPlainPower || exponent > kMostPlainPower) return text;
  // What stands before the power of ten, moved to its place: 4.1e+02 becomes 410, 1.8e-05 becomes 0.000018.
  const std::size_t point = text.find('.');
  const int behind_point = point < power ? static_cast<int>(power - point) - 1 : 0;
  return fmt::format("{:.{}f}", std::stod(text), std::max(0, behind_point - exponent));
}

std::string value_text(double value, double sd) {
  if (!std::isfinite(value) || !usable(sd)) return number_text(value, 6);
  return fmt::format("{:.{}f}", value, decimals_of(sd));
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
  return fmt::format("{:+.{}f}", error, decimals_of(sd));
}

std::string gain_text(double gain) {
  constexpr double kDecimalsBelow = 1e3, kDigitsBelow = 1e6;
  if (!std::isfinite(gain)) return number_text(gain);
  if (std::abs(gain) < kDecimalsBelow) return fmt::format("{:+.1f}", gain);
  if (std::abs(gain) < kDigitsBelow) return fmt::format("{:+.0f}", gain);
  constexpr std::array<const char*, 10> kRaised = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const std::string text = fmt::format("{:+.3e}", gain);
  const std::size_t power = text.find('e');
  std::string raised;
  for (const char digit : std::to_string(std::stoi(text.substr(power + 1)))) {
    raised += kRaised[static_cast<std::size_t>(digit - '0')];
  }
  return text.substr(0, power) + "·10" + raised;
}

std::string r2_text(double r2) {
  if (!std::isfinite(r2)) return "–";
  // Never rounded up to 1: 0.99999996 keeps its digits.
  for (int decimals = 5; decimals < kMostDecimals; ++decimals) {
    std::string text = fmt::format("{:.{}f}", r2, decimals);
    if (r2 >= 1.0 || !text.starts_with("1.")) return text;
  }
  return fmt::format("{:.{}f}", r2, kMostDecimals);
}

}  // namespace glidelab::base
