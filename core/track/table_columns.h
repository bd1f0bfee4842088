/// Chooses the columns of an exported table that hold x and its time.
///
/// x is the requested column, given by its header, its name or its number from 1 on; otherwise the one named x,
/// position, distance or displacement (or the equivalent in other languages), if there is just one; if there is none,
/// the one named y or height. If both x and y are present (Tracker writes both), x is the one along which the body
/// moves: y if its extent is three times as large. If its straight path makes an angle of more than 5 degrees with that
/// axis, positions are taken along the path, from both columns. A curved path of the two, an arc or one that turns to
/// and fro by more than 12 degrees, is not motion along a line, and is refused; a smaller bend that its noise does not
/// explain is told (core/math/plane_path.h).
///
/// A requested x whose y stands beside it is read alone; a note says so where the path is not along x.
///
/// Three columns without a header are t, x and a third: y, if it follows x along a line; a third that is neither this
/// nor the speed dx/dt is not used, and one that makes a curve with x is refused.
///
/// Its time is the nearest column to the left that is named t or time or has a unit of time, of the same run if runs
/// are stated; otherwise the only one. In a file without a header the first column is the time; of two columns the
/// second, if it alone increases throughout, in even steps or while the first often goes back, and whichever is not
/// asked for as x. A note says so if both could be times; if the second then has far more even steps, x must be asked
/// for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/analysis_note.h"
#include "core/track/column_table.h"
#include "core/track/path_columns.h"

namespace glidelab::core {

/// Whether a column of frame numbers serves as that of times, where no other does.
enum class FrameNumbers { are_no_times, are_times };

/// InputError: no or several candidates for x or t, a curved path.
ChosenColumns choose_columns(const ColumnTable& table, const std::string& asked, FrameNumbers frame_numbers,
                             std::vector<Note>& notes);

/// The columns of a table that has speeds and no positions, or of which a column of speeds is requested, where `place`
/// is the one of the speeds; empty for any other table, and where none is requested for one with a quantity of one
/// letter without a unit, which may be the distance. InputError: several speeds and none requested; no such column; no
/// or several columns of time.
std::optional<ChosenColumns> choose_speeds(const ColumnTable& table, const std::string& asked,
                                           FrameNumbers frame_numbers);

/// Metres (or seconds, or metres a second) per number of a column; adds a note if it states no unit. InputError for
/// another unit.
double metres_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes);
double metres_per_second_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes);
double seconds_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes);

/// The first row that repeats the value above it, of values that never fall and rise somewhere: times that were
/// rounded, or rows that stand twice. Empty for others.
std::optional<std::size_t> first_repeated(const TableColumn& times);

/// Whether at least half of the steps are positive. Otherwise these are not times at all, rather than times with an
/// error among them.
bool rises_mostly(const TableColumn& times);

}  // namespace glidelab::core
