#include "core/track/clock_time.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string>

namespace glidelab::core {
namespace {

constexpr double kDay_s = 86400.0, kHour_s = 3600.0, kMinute_s = 60.0;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The digits at the front, `fewest` to `most` of them, which are taken off; empty if there are fewer or more.
std::optional<int> take_digits(std::string_view& text, std::size_t fewest, std::size_t most) {
  const auto end = static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
  if (end < fewest || end > most) return {};
  int value = 0;
  std::from_chars(text.data(), text.data() + end, value);
  text.remove_prefix(end);
  return value;
}

bool take(std::string_view& text, std::string_view signs) {
  if (text.empty() || signs.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

/// A date at the front, which is taken off.
bool take_date(std::string_view& text) {
  std::string_view rest = text;
  if (!take_digits(rest, 1, 4) || rest.empty()) return false;
  const std::string_view sign = rest.substr(0, 1);
  if (!take(rest, "-/.") || !take_digits(rest, 1, 2) || !take(rest, sign) || !take_digits(rest, 1, 4)) return false;
  text = rest;
  return true;
}

/// Of a decimal sign and its digits; 0 if there is no such sign.
std::optional<double> take_fraction(std::string_view& text) {
  if (!take(text, ".,")) return 0.0;
  const auto end = static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
  if (end == 0) return {};
  double value = 0.0;
  const std::string digits = "0." + std::string(text.substr(0, end));
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  text.remove_prefix(end);
  return value;
}

/// Nothing, a time zone ("Z", "+01:00"), or AM or PM, which says where the hours begin.
std::optional<double> hours_of_ending(std::string_view text, int hour) {
  while (take(text, " ")) {
  }
  if (text.empty() || text == "Z" || text == "z") return 0.0;
  std::string lower;
  for (const char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == "am" || lower == "pm") {
    if (hour < 1 || hour > 12) return {};
    return (lower == "pm" ? 12.0 : 0.0) - (hour == 12 ? 12.0 : 0.0);
  }
  if (!take(text, "+-") || !take_digits(text, 2, 2)) return {};
  take(text, ":");
  return text.empty() || (take_digits(text, 2, 2) && text.empty()) ? std::optional(0.0) : std::nullopt;
}

}  // namespace

std::optional<double> clock_time_in(std::string_view field) {
  if (field.find(':') == std::string_view::npos) return {};
  if (std::string_view dated = field; take_date(dated)) {
    if (!take(dated, " T")) return {};
    field = dated;
  }
  const auto first = take_digits(field, 1, 3);
  if (!first || !take(field, ":")) return {};
  const auto second = take_digits(field, 2, 2);
  if (!second || *second >= 60) return {};
  if (!take(field, ":")) {  // minutes and seconds
    const bool has_fraction = !field.empty();
    const auto fraction = take_fraction(field);
    if (!has_fraction || !fraction || !field.empty()) return {};
    return *first * kMinute_s + *second + *fraction;
  }
  const auto third = take_digits(field, 2, 2);
  if (*first > 23 || !third || *third > 60) return {};  // 60: a leap second
  const auto fraction = take_fraction(field);
  if (!fraction) return {};
  const auto hours = hours_of_ending(field, *first);
  if (!hours) return {};
  return (*first + *hours) * kHour_s + *second * kMinute_s + *third + *fraction;
}

bool is_date(std::string_view field) {
  return take_date(field) && field.empty();
}

void count_from_first(std::vector<std::optional<double>>& times_s) {
  std::optional<double> first, before;
  double days_s = 0.0;
  for (std::optional<double>& time : times_s) {
    if (!time) continue;
    if (!first) first = *time;
    if (before && *time < *before - kDay_s / 2.0) days_s += kDay_s;
    before = *time;
    *time += days_s - *first;
  }
}

}  // namespace glidelab::core
