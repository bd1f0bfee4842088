#include "core/track/number_field.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

namespace glidelab::core {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// Without the blanks that divide digits into groups of three, "1 234,5"; unchanged if there are others, or if the
/// digits before the first are no group: more than three, or a zero.
std::string without_groups(const std::string& text) {
  const auto digit = [&](std::size_t at) { return at < text.size() && text[at] >= '0' && text[at] <= '9'; };
  const std::size_t first = text.find_first_of("0123456789"), blank = text.find(' ');
  if (first >= blank || text[first] == '0' || blank - first > 3) return text;
  std::string joined;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != ' ') {
      joined += text[i];
      continue;
    }
    const bool group = i > 0 && digit(i - 1) && digit(i + 1) && digit(i + 2) && digit(i + 3) && !digit(i + 4);
    if (!group) return text;
  }
  return joined;
}

/// As spreadsheets write numbers in some languages: the Unicode minus sign, blanks between thousands.
std::string plain_number(std::string_view field, Thousands thousands) {
  std::string text(field);
  if (thousands == Thousands::without_plain_blanks && text.find(' ') != std::string::npos) return text;
  const bool ascii = std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80; });
  if (!ascii) {
    replace_all(text, "\xE2\x88\x92", "-");                                              // U+2212
    for (const std::string_view blank : {"\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89"}) {  // no-break, narrow, thin
      replace_all(text, blank, " ");
    }
  }
  return text.find(' ') == std::string::npos ? text : without_groups(text);
}

/// A field without blanks and quotes around it.
std::string_view field_text(std::string_view field) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '"'; };
  while (!field.empty() && blank(field.front())) field.remove_prefix(1);
  while (!field.empty() && blank(field.back())) field.remove_suffix(1);
  return field;
}

/// A delimiter within quotes does not count.
std::vector<std::string_view> split_at(std::string_view line, char delimiter) {
  std::vector<std::string_view> fields;
  std::size_t from = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != delimiter)) continue;
    fields.push_back(field_text(line.substr(from, i - from)));
    from = i + 1;
  }
  return fields;
}

/// At runs of blanks and tabs; a unit in brackets belongs to the name before it.
std::vector<std::string_view> split_at_blanks(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const auto from = line.find_first_not_of(" \t\r");
    if (from == std::string_view::npos) return fields;
    line.remove_prefix(from);
    const char* const start = line.data();
    const bool quoted = line.front() == '"';
    const auto end = quoted ? line.find('"', 1) : line.find_first_of(" \t\r");
    const auto size = end == std::string_view::npos ? line.size() : end + (quoted ? 1 : 0);
    const bool is_unit = line.front() == '(' || line.front() == '[';
    if (is_unit && !fields.empty()) {
      const char* const first = fields.back().data();
      fields.back() = std::string_view(first, static_cast<std::size_t>(start + size - first));
    } else {
      fields.push_back(field_text(line.substr(0, size)));
    }
    line.remove_prefix(size);
  }
}

}  // namespace

std::vector<std::string_view> split_fields(std::string_view line, char delimiter) {
  return delimiter == kBlanks ? split_at_blanks(line) : split_at(line, delimiter);
}

bool is_missing(std::string_view field) {
  static constexpr std::array<std::string_view, 18> kSpellings{
      "",   "NaN", "nan", "NAN",  "-",    "--",   "---",  "\xE2\x80\x93", "\xE2\x80\x94",
      "NA", "N/A", "n/a", "null", "NULL", "None", "#N/A", "#NV",          "#DIV/0!"};
  return std::ranges::find(kSpellings, field) != kSpellings.end();
}

std::optional<double> number_in(std::string_view field, char decimal, Thousands thousands) {
  std::string text = plain_number(field, thousands);
  if (decimal == ',') {
    if (text.find('.') != std::string::npos) return {};
    std::replace(text.begin(), text.end(), ',', '.');
  }
  const char* first = text.data();
  if (text.starts_with("+")) ++first;
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

void DecimalSign::see(std::string_view field) {
  const auto at = field.find_first_of(",.");
  if (at == std::string_view::npos) return;
  const std::string_view before = field.substr(0, at), after = field.substr(at + 1);
  const bool three = after.size() == 3 && after.find_first_not_of("0123456789") == std::string_view::npos;
  const auto first = before.find_first_of("123456789");  // 0,149 has no thousands
  (field[at] == ',' ? commas : points) = true;
  only_thousands = only_thousands && three && first != std::string_view::npos;
  example = field;
}

bool is_month_and_number(std::string_view field) {
  const auto dot = field.find('.');
  if (dot == std::string_view::npos) return false;
  const std::string_view before = field.substr(0, dot), after = field.substr(dot + 1);
  const auto word = [](std::string_view text) {
    return text.size() >= 3 && std::all_of(text.begin(), text.end(), [](char c) {
             return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 0x80;
           });
  };
  const auto digits = [](std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  };
  return (digits(before) && word(after)) || (word(before) && digits(after));
}

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
