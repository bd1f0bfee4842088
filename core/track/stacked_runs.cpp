#include "core/track/stacked_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidelab::core {
namespace {

/// "Run", "Trial", …: what numbers runs where times of day go on from one to the next.
bool names_runs(const TableColumn& column) {
  static constexpr std::array<std::string_view, 10> kNames{"run",     "trial", "clip",   "series", "versuch",
                                                           "messung", "essai", "prueba", "prova",  "ensaio"};
  std::string name;
  for (const char c : column.name) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::ranges::find(kNames, name) != kNames.end();
}

/// Rows of one run, [from, to), and its number in the table.
struct StackedRun {
  std::size_t from = 0, to = 0;
  double number = 0.0;
};

/// The runs that this column numbers: whole numbers that each stay for rows on end and do not return, with times that
/// rise within a run and begin anew in the next, or go on if they are times of day; none otherwise.
std::vector<StackedRun> stacked_runs(const TableColumn& numbers, const TableColumn& times, bool go_on) {
  std::vector<StackedRun> runs;
  std::set<double> seen;
  for (std::size_t row = 0; row < numbers.values.size(); ++row) {
    const std::optional<double>&number = numbers.values[row], &time = times.values[row];
    if (!number || !time || *number != std::round(*number)) return {};
    const bool is_next = runs.empty() || *number != runs.back().number;
    const bool falls = row > 0 && (go_on ? is_next : *time <= *times.values[row - 1]);
    if (is_next != (runs.empty() || falls) || (is_next && !seen.insert(*number).second)) return {};
    if (is_next) runs.push_back({row, row, *number});
    runs.back().to = row + 1;
  }
  return runs.size() < 2 ? std::vector<StackedRun>() : runs;
}

}  // namespace

void put_side_by_side(ColumnTable& table, bool times_of_day) {
  const auto time = std::ranges::find_if(table.columns, is_time_column);
  if (!table.has_header || time == table.columns.end()) return;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const TableColumn& numbers = table.columns[c];
    if (&numbers == &*time || is_place_column(numbers) || is_height_column(numbers)) continue;
    if (times_of_day && !names_runs(numbers)) continue;
    const std::vector<StackedRun> runs = stacked_runs(numbers, *time, times_of_day);
    if (runs.empty()) continue;
    if (runs.size() > kMostFields / (table.columns.size() * table.line.size())) return;
    std::vector<TableColumn> columns;
    for (const StackedRun& run : runs) {
      for (std::size_t of = 0; of < table.columns.size(); ++of) {
        if (of == c) continue;
        TableColumn column = table.columns[of];
        column.run = fmt::format("{} {}", numbers.name, run.number);
        column.text = fmt::format("{} {}", column.text, column.run);
        const int first = table.line[run.from], last = table.line[run.to - 1];
        std::erase_if(column.texts, [&](const base::Issue& text) { return text.line < first || text.line > last; });
        for (std::size_t row = 0; row < column.values.size(); ++row) {
          if (row < run.from || row >= run.to) column.values[row].reset();
        }
        columns.push_back(std::move(column));
      }
    }
    table.columns = std::move(columns);
    return;
  }
}

}  // namespace glidelab::core
