/// Tables of numbers as other programs export them: Tracker, Logger Pro and Vernier Graphical Analysis, PASCO Capstone,
/// phyphox, spreadsheets.
///
/// These forms are understood, whatever the file's name: tab, semicolon, comma or blanks between fields; decimal point
/// or decimal comma; quoted fields; LF or CRLF, a byte-order mark; titles and comments ('#') before the header, or a
/// header after a '#'; one to three header lines (a padded line of runs, or of bodies that several columns belong to;
/// names, short names, units); channels as "Position, Ch 1 (m)"; units as "Time (s)", "x [cm]", "x_mm", "x / cm", "x in
/// cm" or in a line of their own; runs as "Run 1: Time (s)", "Time (s) Run #1" or in a line of their own; columns of
/// different lengths; NaN for no value; the Unicode minus sign (U+2212); blanks between thousands. A decimal comma
/// goes with a comma between fields if each number that has one is in quotes. The delimiter and the decimal sign are
/// chosen so that most lines consist only of numbers, or have numbers in the same columns. Text in other columns, as
/// labels and remarks are, is no value. Brackets around digits belong to the name: "cal[0]".
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include "base/errors.h"

namespace glidelab::core {

struct TableColumn {
  std::string text;                           ///< the header as written; "column 2" if there is none
  std::string name;                           ///< without unit and run
  std::string unit;                           ///< empty if none is stated
  std::string run;                            ///< empty if none is stated
  std::vector<std::optional<double>> values;  ///< one for each data line; empty if the field is empty, NaN or text
  std::vector<base::Issue> texts = {};        ///< fields between the numbers that hold text, the first ten
};

/// Units of length and time as tables state them: symbols, and words in English, German, French, Spanish, Portuguese
/// and Italian.
///
/// Metres for a unit of length ("mm", "Zentimeter", "inches"), seconds for a unit of time; empty for any other text.
/// "um" and "µm" are the same.
std::optional<double> metres_per(std::string_view unit);
std::optional<double> seconds_per(std::string_view unit);

/// "t", "time", "Zeit", …
bool is_time_name(std::string_view name);

/// Whether it is a column of times, by its unit or, if it states none, by its name.
bool is_time_column(const TableColumn& column);

/// Whether the column is named x, position, distance or displacement (or the equivalent in German, French, Italian,
/// Portuguese, Spanish) and is not a column of times.
bool is_place_column(const TableColumn& column);

/// Whether the column is named y, height (or the equivalent in other languages): the second coordinate of a body in a
/// plane, or the only one of a fall.
bool is_height_column(const TableColumn& column);

/// The header lines of an exported table, split into name, unit and run of each of its `width` columns, which have no
/// values yet. The lines, first to last: runs (if all fields mention a run, a set or "latest", or if there are fewer
/// fields than names below, one of which is a time: "mass A" above t, x, y), names, short names (ignored), units. All
/// but the names may be missing.
std::vector<TableColumn> columns_of_header(const std::vector<std::vector<std::string>>& lines, std::size_t width);

/// Whether all that is there of a header line are units: "[s]", "m", "m/s".
bool holds_units(const std::vector<std::string>& line);

struct ColumnTable {
  std::string file;
  bool has_header = false;
  std::vector<TableColumn> columns;  ///< two or more
  std::vector<int> line;             ///< of each data line, 1-based
  std::string sheet = {};            ///< of a workbook with several
  std::size_t dates = 0;             ///< cells of a workbook left empty because they show a date or a time of day
};

/// `name` is the file, for messages. InputError as below.
ColumnTable table_of_text(std::string_view text, const std::string& name);

/// A workbook of Excel (workbook.h), or text. The text may be UTF-8, UTF-16 or Latin-1 (text_encoding.h). InputError if
/// the file does not have two columns of numbers, or is no text (a spreadsheet's own format, JSON). Text between the
/// numbers of a column is an issue for whoever uses that column.
ColumnTable read_column_table(const std::filesystem::path& file);

}  // namespace glidelab::core
