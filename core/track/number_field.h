/// Numbers as programs and spreadsheets write them into the fields of a table.
#pragma once

#include <optional>
#include <string_view>

namespace glidelab::core {

/// Whether a plain blank may stand between thousands. Where commas separate the fields it may not: "40,5 123,5" are two
/// numbers with decimal commas.
enum class Thousands { with_blanks, without_plain_blanks };

/// The number of a field, with a decimal point or a decimal comma. The Unicode minus sign (U+2212) and blanks between
/// groups of three digits ("1 234,5") are understood, as spreadsheets write them in some languages. Empty if the field
/// holds anything else, also the other decimal sign.
std::optional<double> number_in(std::string_view field, char decimal, Thousands thousands = Thousands::with_blanks);

/// "01.jan", "jan.13": what a spreadsheet makes of 1.01 and 1.13 if it expects a decimal comma.
bool is_month_and_number(std::string_view field);

}  // namespace glidelab::core
