/// Tables in workbooks of Excel (.xlsx, Office Open XML, ECMA-376 part 1: spreadsheets).
///
/// The first sheet with at least kFewestSheetRows rows of two or more numbers is read. Its cells go to the reader of
/// text tables (column_table.h), tab by tab, so that headers, units and runs are recognised as in an exported text. The
/// line of an error is the sheet's row. A formula has the value that the program which saved the workbook computed.
/// Errors ("#DIV/0!") and empty cells are missing values. A cell whose format shows a date or a time of day is no
/// number: it counts days.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace glidelab::core {

/// Whether the file is a zip archive that holds a spreadsheet: .xlsx, or .xlsb and .ods, which read_sheet()
/// refuses. InputError if it begins like a zip archive and is none.
bool is_spreadsheet(const std::filesystem::path& file);

/// The sheet that is read, one line a row at the row's number and a tab between cells.
struct SheetText {
  std::string text;
  std::string shown_as;   ///< the file and its sheet, for messages
  std::string sheet;      ///< its name if there are several; empty otherwise
  std::size_t dates = 0;  ///< cells left empty because they show a date or a time of day
};

/// InputError: another kind of spreadsheet; a part that is missing, damaged, larger than kMostPartBytes or has a
/// document type; more than kMostSheets sheets; more than kMostBytesOfSheets unpacked before a sheet with a table is
/// found; a sheet that is larger than kMostSheetBytes as text; no numbers but dates or times of day.
SheetText read_sheet(const std::filesystem::path& file);

/// What a message says of dates or times of day where times should be.
std::string dates_expectation();

inline constexpr std::size_t kFewestSheetRows = 5;  ///< a few numbers next to each other may be settings
inline constexpr std::size_t kMostSheets = 1000;
/// Of an unpacked part. XML of this size that is all small elements takes several hundred MiB while it is read.
inline constexpr std::size_t kMostPartBytes = std::size_t{32} << 20;
inline constexpr std::size_t kMostBytesOfSheets = std::size_t{256} << 20;  ///< unpacked, one after another
inline constexpr std::size_t kMostSheetBytes = std::size_t{64} << 20;  ///< with a tab for each cell that is left out

}  // namespace glidelab::core
