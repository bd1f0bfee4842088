/// Which columns of an exported table are x and its time.
///
/// x is the column that is asked for, by its header, its name or its number from 1 on; otherwise the one that is called
/// x, position, distance or displacement (or the like in other languages), if there is just one; without any, the one
/// that is called y or height. Where both x and y are there (Tracker writes both) x is the one along which the body
/// moves: y where it covers three times as much. A curved path of the two is no motion along a line, and is refused.
///
/// Its time is the nearest column to the left that is called t or time or has a unit of time, of the same run where
/// runs are stated; else the only one there is. In a file without header the first column is the time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/result/analysis_note.h"
#include "core/track/column_table.h"

namespace glidelab::core {

struct ChosenColumns {
  std::size_t place = 0, time = 0;
  bool is_height = false;  ///< x is a height that nobody asked for: its sign is not stated
};

/// InputError: no or several columns that x or t may be, a curved path.
ChosenColumns choose_columns(const ColumnTable& table, const std::string& asked, std::vector<Note>& notes);

/// Metres for the numbers of a column, or seconds; a note where it states no unit. InputError for another unit.
double metres_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes);
double seconds_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes);

/// Whether at least half of the steps go up: else they are no times, and not times with a mistake among them.
bool rises_mostly(const TableColumn& times);

}  // namespace glidelab::core
