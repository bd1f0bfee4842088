/// Tables of numbers as other programs export them: Tracker, Logger Pro and Vernier Graphical Analysis, PASCO Capstone,
/// phyphox, spreadsheets.
///
/// Understood, whatever the file's name: tab, semicolon or comma between fields; decimal point or decimal comma; quoted
/// fields; LF or CRLF, a byte-order mark; titles and comments ('#') before the header; one to three header lines (a
/// line of runs, names, short names, units); units as "Time (s)", "x [cm]", "x_mm" or in a line of their own; runs as
/// "Run 1: Time (s)", "Time (s) Run #1" or in a line of their own; columns of different lengths; NaN for no value.
/// The delimiter and the decimal sign are those with which most lines are all numbers.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/track/column_header.h"

namespace glidelab::core {

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
