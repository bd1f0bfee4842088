/// The columns of a table that another program exported, by its header lines: names, units and runs, in English,
/// German, French, Spanish, Portuguese, Italian and, for names, the languages of the North.
#pragma once

#include <cstddef>
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

/// A table of numbers (column_table.h).
struct ColumnTable {
  std::string file;
  bool has_header = false;
  std::vector<TableColumn> columns;  ///< two or more
  std::vector<int> line;             ///< of each data line, 1-based
  std::string sheet = {};            ///< of a workbook with several
  std::size_t dates = 0;             ///< cells of a workbook left empty because they show a date or a time of day
  std::optional<double> frame_rate_hz = {};  ///< as a line above the header states it
};

/// Units of length and time as tables state them: symbols, and words in English, German, French, Spanish, Portuguese
/// and Italian.
///
/// Metres for a unit of length ("mm", "Zentimeter", "inches"), seconds for a unit of time; empty for any other text.
/// "um" and "µm" are the same.
std::optional<double> metres_per(std::string_view unit);
std::optional<double> seconds_per(std::string_view unit);

/// "px", "pixel", "pixels".
bool is_pixels(std::string_view unit);

/// "frame", "Bild", "fotograma": counts images and is no time.
bool is_frame_column(const TableColumn& column);

/// "likelihood", "confidence", of 0 to 1: how sure a program is that it sees the body there.
bool is_likelihood_column(const TableColumn& column);

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

/// Whether it is the position of a motion sensor, as the programs of such sensors head it: "Position, Ch 1 (m)",
/// "Position (m) Run #2" (Capstone), "Latest: Position (m)", "Run 1: Distance (m)" (Logger Pro).
bool is_sensor_column(const TableColumn& column);

/// The header lines of an exported table, split into name, unit and run of each of its `width` columns, which have no
/// values yet. The lines, first to last: runs (if all fields mention a run, a set or "latest", or if there are fewer
/// fields than names below, one of which is a time: "mass A" above t, x, y), names, short names (ignored), units. All
/// but the names may be missing. DeepLabCut has lines of its own, which begin with "bodyparts" and "coords": a run is
/// then a part of the body, in pixels.
std::vector<TableColumn> columns_of_header(const std::vector<std::vector<std::string>>& lines, std::size_t width);

/// The lines above the numbers, without statements such as "FREQUENCY 500", and what these state.
struct StatedAbove {
  std::vector<std::vector<std::string>> header;
  std::optional<double> frame_rate_hz = {};
};

/// A statement is a line of a name and numbers. Behind it, shorter lines than the last one are statements as well: the
/// header is what stands just above the numbers. Qualisys (a line MARKER_NAMES) writes x, y and z of each marker in
/// millimetres, below a header "cart X", or below none; the lines that are returned then say so.
StatedAbove without_statements(std::vector<std::vector<std::string>> lines, std::size_t width);

/// Whether all that is there of a header line are units: "[s]", "m", "m/s".
bool holds_units(const std::vector<std::string>& line);

}  // namespace glidelab::core
