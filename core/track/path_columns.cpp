#include "core/track/path_columns.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <string>

#include "base/math/angles.h"
#include "core/math/false_positions.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kStraightPath = 0.08;  // sagitta over length: a wide-angle lens bends a straight path by half of that
constexpr double kLeastSteps = 2.0;     // of rounded coordinates: less is a staircase, and no bend
constexpr double kBendOverNoise = 5.0, kLeastBend = 2e-3;  // of a notable bend, and over the length of the path
constexpr double kMostlyArc = 0.5;                         // of the range of a bend: a lens makes arcs
constexpr double kMostTurn_deg = 12.0;  // between parts of a path that is no arc: 2 m/s² along the motion
constexpr double kSlanted_deg = 5.0;    // x is then too short by 0.4 %

}  // namespace

PlanePath path_of(const TableColumn& x, const TableColumn& y) {
  PlanePath path;
  std::vector<double> rows;
  const double x_unit = metres_per(x.unit).value_or(1.0),
               y_unit = y.unit.empty() ? x_unit : metres_per(y.unit).value_or(1.0);
  for (std::size_t row = 0; row < x.values.size(); ++row) {
    if (!x.values[row] || !y.values[row]) continue;
    path.x_m.push_back(*x.values[row] * x_unit);
    path.y_m.push_back(*y.values[row] * y_unit);
    rows.push_back(static_cast<double>(row));
  }
  for (const std::vector<double>* const places : {&path.x_m, &path.y_m}) {
    const std::optional<UnseenPositions> unseen = unseen_positions(rows, *places);
    if (!unseen) continue;
    return {without_flagged(path.x_m, unseen->is_unseen), without_flagged(path.y_m, unseen->is_unseen)};
  }
  return path;
}

double range_of(const std::vector<double>& values) {
  return quantile(values, 0.98) - quantile(values, 0.02);
}

namespace {

std::string straight_motion(const std::string& y) {
  return fmt::format(
      "the motion of a body along a straight line, not a free flight, a swing, a turn or a wavy track; if {} is not a "
      "position, say which column is x (--column)",
      y);
}

}  // namespace

void refuse_curve(const ColumnTable& table, std::size_t x, std::size_t y, const PlanePath& path) {
  const double bend = sagitta_of(path);
  if (!(bend > kStraightPath)) return;
  const std::string &of_x = table.columns[x].name, &of_y = table.columns[y].name;
  throw wrong_column(
      table, fmt::format("a curved path: the sagitta of ({}, {}) is {:.2g} % of its length", of_x, of_y, 100.0 * bend),
      straight_motion(of_y));
}

namespace {

/// Whether a bend is clear: a body at rest, noise and rounding make none.
bool is_clear(const PathBend& bend) {
  return bend.length_m > 0.0 && bend.range_m > kLeastSteps * bend.step_m &&
         bend.range_m >= kBendOverNoise * bend.noise_m && bend.range_m >= kLeastBend * bend.length_m;
}

}  // namespace

void judge_bend(const ColumnTable& table, std::size_t x, std::size_t y, const PlanePath& path,
                std::vector<Note>& notes) {
  const bool pixels = is_pixels(table.columns[y].unit);  // notes have metres
  const PathBend bend = bend_of(path);
  if (!is_clear(bend)) return;
  const bool arc = sagitta_of(path) * bend.length_m > kMostlyArc * bend.range_m;
  if (bend.range_m < kStraightPath * bend.length_m && (arc || bend.slope_deg < kMostTurn_deg)) {
    if (!pixels) notes.emplace_back(PathBends{bend.range_m, bend.slope_deg});
    return;
  }
  throw wrong_column(
      table,
      fmt::format("a curved path: ({}, {}) strays over {:.2g} {} across the best straight line, {:.2g} % of its "
                  "length, and its direction changes by {:.0f}°",
                  table.columns[x].name, table.columns[y].name, bend.range_m, pixels ? "px" : "m",
                  100.0 * bend.range_m / bend.length_m, bend.slope_deg),
      straight_motion(table.columns[y].name));
}

void note_other_axis(const ColumnTable& table, std::size_t x, std::vector<Note>& notes) {
  const std::size_t y = x + 1;
  if (y >= table.columns.size() || !is_place_column(table.columns[x]) || !is_height_column(table.columns[y])) return;
  const TableColumn& other = table.columns[y];
  if (other.run != table.columns[x].run || (!other.unit.empty() && !metres_per(other.unit))) return;
  const PlanePath path = path_of(table.columns[x], other);
  if (path.x_m.size() < kFewestOfPath) return;
  const double off_deg = std::abs(slant_deg(path));
  const PathBend bend = bend_of(path);
  if (off_deg > kSlanted_deg || is_clear(bend)) notes.emplace_back(OtherAxisUnused{other.text, off_deg, bend.range_m});
}

ChosenColumns along_path(const ColumnTable& table, std::size_t x, std::size_t y, std::vector<Note>& notes) {
  ChosenColumns chosen;
  chosen.place = x;
  const TableColumn& other = table.columns[y];
  const bool pixels = is_pixels(other.unit) && (table.columns[x].unit.empty() || is_pixels(table.columns[x].unit));
  if (!other.unit.empty() && !metres_per(other.unit) && !pixels) return chosen;  // no length beside x
  const PlanePath path = path_of(table.columns[x], other);
  if (path.x_m.size() < kFewestOfPath) return chosen;
  refuse_curve(table, x, y, path);
  judge_bend(table, x, y, path, notes);
  const double range_x = range_of(path.x_m), range_y = range_of(path.y_m);
  const bool upright = range_y > kOtherAxis * range_x;
  if (upright) {
    if (!pixels) notes.emplace_back(MotionAlongY{range_y, range_x});
    chosen.place = y;
  }
  const double from_x_deg = slant_deg(path);
  const double off_deg = upright ? 90.0 - std::abs(from_x_deg) : std::abs(from_x_deg);
  if (off_deg > kSlanted_deg) {
    const double off = off_deg / base::kDegreesPerRad;
    chosen.across = Across{upright ? x : y, std::cos(off), std::copysign(std::sin(off), from_x_deg)};
    notes.emplace_back(SlantedPath{off_deg, 1.0 / std::cos(off), upright});
  }
  return chosen;
}

}  // namespace glidelab::core
