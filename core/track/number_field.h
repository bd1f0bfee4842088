/// The fields of a table's line, and the numbers and times of day in them as programs and spreadsheets write them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace glidelab::core {

inline constexpr char kBlanks = ' ';  ///< as a delimiter: any number of blanks and tabs

/// Without blanks and quotes around them. A delimiter within quotes does not count. At blanks, a unit in brackets
/// belongs to the name before it.
std::vector<std::string_view> split_fields(std::string_view line, char delimiter);

/// Nothing, or a spelling of "no value": "NaN", "NA", "null", a dash, "#N/A", …
bool is_missing(std::string_view field);

/// Whether a plain blank may stand between thousands. Where commas separate the fields it may not: "40,5 123,5" are two
/// numbers with decimal commas.
enum class Thousands { with_blanks, without_plain_blanks };

/// The number of a field, with a decimal point or a decimal comma. The Unicode minus sign (U+2212) and blanks between
/// groups of three digits ("1 234,5") are understood, as spreadsheets write them in some languages. Empty if the field
/// holds anything else, also the other decimal sign.
std::optional<double> number_in(std::string_view field, char decimal, Thousands thousands = Thousands::with_blanks);

/// The decimal sign that the numbers of one column show. `example` is the last of them that has one, a view of it.
struct DecimalSign {
  bool points = false, commas = false;
  bool only_thousands = true;  ///< three digits follow each of them, and a number above zero is before it
  std::string_view example = {};

  void see(std::string_view field);
  /// "1,234" and the like in all fields with a sign: 1.234, or 1234.
  bool may_be_thousands() const { return (points || commas) && only_thousands; }
};

/// "01.jan", "jan.13": what a spreadsheet makes of 1.01 and 1.13 if it expects a decimal comma.
bool is_month_and_number(std::string_view field);

/// Seconds since midnight of "14:03:07.25", also after a date ("2024-03-05 14:03:07", "2024-03-05T14:03:07.25Z") and
/// before AM or PM; of a stopwatch's minutes and seconds, "1:02.75", which need a fraction to be told from hours and
/// minutes. A decimal point or a decimal comma. Empty for anything else. The date and the time zone do not count.
std::optional<double> clock_time_in(std::string_view field);

/// "2024-03-05", "5.3.2024", "3/5/24": a date and nothing else.
bool is_date(std::string_view field);

/// Times of day of successive rows as seconds from the first of them, across midnight.
void count_from_first(std::vector<std::optional<double>>& times_s);

}  // namespace glidelab::core
