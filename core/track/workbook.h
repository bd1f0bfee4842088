/// Tables in workbooks of Excel (.xlsx, Office Open XML, ECMA-376 part 1: spreadsheets).
///
/// Of the sheets in their order the first counts that has kFewestSheetRows rows with two numbers or more; its cells go
/// to the reader of text tables (column_table.h), tab by tab, so that headers, units and runs are recognised as in an
/// exported text. The line of an error is the sheet's row. A formula has the value that the program which saved the
/// workbook computed. Errors ("#DIV/0!") and empty cells are missing values. A cell whose format shows a date or a time
/// of day is no number: it counts days.
#pragma once

#include <cstddef>
#include <filesystem>

#include "core/track/column_table.h"

namespace glidelab::core {

/// Whether the file is a zip archive that holds a spreadsheet: .xlsx, or .xlsb and .ods, which read_workbook()
/// refuses. InputError if it begins like a zip archive and is none.
bool is_spreadsheet(const std::filesystem::path& file);

/// InputError: another kind of spreadsheet; a part that is missing, damaged, larger than kMostPartBytes or has a
/// document type; a sheet that is larger than kMostSheetBytes as text; dates or times of day in place of times; what
/// table_of_text() refuses.
ColumnTable read_workbook(const std::filesystem::path& file);

inline constexpr std::size_t kFewestSheetRows = 5;  ///< a few numbers beside each other may be settings
inline constexpr std::size_t kMostPartBytes = std::size_t{32} << 20;   ///< unpacked: about a million cells
inline constexpr std::size_t kMostSheetBytes = std::size_t{64} << 20;  ///< with a tab for each cell that is left out

}  // namespace glidelab::core
