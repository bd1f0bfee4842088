/// The path that two columns of an exported table make, x and y of one body, and which of them a motion is read along.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/math/plane_path.h"
#include "core/result/analysis_note.h"
#include "core/track/column_table.h"

namespace glidelab::core {

/// The second column of a path at an angle to the axes: positions are cos * place + sin * this column.
struct Across {
  std::size_t column = 0;
  double cos = 1.0, sin = 0.0;
};

struct ChosenColumns {
  std::size_t place = 0, time = 0;
  std::optional<Across> across = {};
};

inline constexpr double kOtherAxis = 3.0;        ///< extent along y over that along x: above it the motion is along y
inline constexpr std::size_t kFewestOfPath = 8;  ///< positions

/// In metres, without rows that say that nothing was seen: a line to them is no path. May be empty.
PlanePath path_of(const TableColumn& x, const TableColumn& y);

/// From the 2nd to the 98th percentile; `values` is not empty.
double range_of(const std::vector<double>& values);

/// InputError if the path is an arc.
void refuse_curve(const ColumnTable& table, std::size_t x, std::size_t y, const PlanePath& path);

/// A bend of any shape: InputError if it is as large as that of an arc which is refused, or if the path turns to and
/// fro so much that gravity along it changes by more than any drag; a note (PathBends) if it is clear.
void judge_bend(const ColumnTable& table, std::size_t x, std::size_t y, const PlanePath& path,
                std::vector<Note>& notes);

/// A note (OtherAxisUnused) if a requested column of x has its y beside it, and the motion is not along x alone.
void note_other_axis(const ColumnTable& table, std::size_t x, std::vector<Note>& notes);

/// The column, x or y, along which the body moves; both if its path makes an angle with the axes. InputError for a
/// curved path: an arc, or one that turns to and fro.
ChosenColumns along_path(const ColumnTable& table, std::size_t x, std::size_t y, std::vector<Note>& notes);

}  // namespace glidelab::core
