/// Tables of numbers as other programs export them: Tracker, Logger Pro and Vernier Graphical Analysis, PASCO Capstone,
/// phyphox, spreadsheets.
///
/// Understood, whatever the file's name: tab, semicolon, comma or blanks between fields; decimal point or decimal
/// comma; quoted fields; LF or CRLF, a byte-order mark; titles and comments ('#') before the header, or a header behind
/// a '#'; one to three header lines (a line of runs or of the bodies that several columns belong to, padded; names,
/// short names, units); channels as "Position, Ch 1 (m)"; units as "Time (s)", "x [cm]", "x_mm", "x / cm", "x in cm" or
/// in a line of their own; runs as "Run 1: Time (s)", "Time (s) Run #1" or in a line of their own; columns of different
/// lengths; NaN for no value. The delimiter and the decimal sign are those with which most lines are all numbers.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::core {

struct TableColumn {
  std::string text;                           ///< the header as it stands; "column 2" where there is none
  std::string name;                           ///< without unit and run
  std::string unit;                           ///< empty where none is stated
  std::string run;                            ///< empty where none is stated
  std::vector<std::optional<double>> values;  ///< one for each data line; nothing where the field is empty or NaN
};

/// "t", "time", "Zeit", …
bool is_time_name(std::string_view name);

/// A column of times, by its unit or, where it states none, its name.
bool is_time_column(const TableColumn& column);

/// A column that is called x, position, distance or displacement (or the like in German, French, Italian, Portuguese,
/// Spanish) and is none of times.
bool is_place_column(const TableColumn& column);

/// One that is called y, height (or the like in other languages): the other coordinate of a body in a plane, or the
/// only one of a fall.
bool is_height_column(const TableColumn& column);

/// Metres for a unit of length, seconds for one of time; nothing for any other text. "um" and "µm" are one.
std::optional<double> metres_per(std::string_view unit);
std::optional<double> seconds_per(std::string_view unit);

/// The header lines of an exported table, taken apart into name, unit and run of each of its `width` columns, which
/// have no values yet. The lines, first to last: of runs (where all its fields speak of a run, a set or "latest", or
/// where it has fewer fields than the names below it, of which one is a time: "mass A" over t, x, y), of names, of
/// short names (ignored), of units; each but the names may be missing.
std::vector<TableColumn> columns_of_header(const std::vector<std::vector<std::string>>& lines, std::size_t width);

struct ColumnTable {
  std::string file;
  bool has_header = false;
  std::vector<TableColumn> columns;  ///< two or more
  std::vector<int> line;             ///< of each data line, 1-based
};

/// InputError where the file has no two columns of numbers, is UTF-16, or where text stands between the numbers (up to
/// ten issues, with line and column).
ColumnTable read_column_table(const std::filesystem::path& file);

}  // namespace glidelab::core
