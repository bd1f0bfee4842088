/// Tables whose runs stand one below the other, told apart by a column of whole numbers.
#pragma once

#include <cstddef>

#include "core/track/column_header.h"

namespace glidelab::core {

/// The largest number of fields that a table may have: 1.6 GB. A file of 1 GiB holds about 60 million of t and x.
inline constexpr std::size_t kMostFields = 100'000'000;

/// Puts the runs side by side, each value in its row. A column numbers runs if its whole numbers stay for rows on end
/// and do not return, and times rise within a run and begin anew in the next. `times_of_day` go on from run to run; the
/// column must then be called "Run", "Trial" or the like. Other tables stay as they are.
void put_side_by_side(ColumnTable& table, bool times_of_day);

}  // namespace glidelab::core
