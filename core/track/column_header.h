/// The header lines of an exported table, taken apart into name, unit and run of each column (column_table.h).
#pragma once

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

/// Metres for a unit of length, seconds for one of time; nothing for any other text. "um" and "µm" are one.
std::optional<double> metres_per(std::string_view unit);
std::optional<double> seconds_per(std::string_view unit);

/// `width` columns without values. The header's lines, first to last: of runs (where all its fields speak of a run, a
/// set or "latest"), of names, of short names (ignored), of units; each but the names may be missing.
std::vector<TableColumn> columns_of_header(const std::vector<std::vector<std::string>>& lines, std::size_t width);

}  // namespace glidelab::core
