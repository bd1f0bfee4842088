/// Times of day and dates in the fields of a table, as loggers and spreadsheets write them.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace glidelab::core {

/// Seconds since midnight of "14:03:07.25", also after a date ("2024-03-05 14:03:07", "2024-03-05T14:03:07.25Z") and
/// before AM or PM; of a stopwatch's minutes and seconds, "1:02.75", which need a fraction to be told from hours and
/// minutes. A decimal point or a decimal comma. Empty for anything else. The date and the time zone do not count.
std::optional<double> clock_time_in(std::string_view field);

/// "2024-03-05", "5.3.2024", "3/5/24": a date and nothing else.
bool is_date(std::string_view field);

/// Times of day of successive rows as seconds from the first of them, across midnight.
void count_from_first(std::vector<std::optional<double>>& times_s);

}  // namespace glidelab::core
