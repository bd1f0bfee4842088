#include "core/track/column_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/experiment/clip_names.h"

namespace glidelab::core {
namespace {

using Unit = std::pair<std::string_view, double>;
constexpr std::array<Unit, 10> kLengths{{{"m", 1.0},
                                         {"cm", 1e-2},
                                         {"mm", 1e-3},
                                         {"um", 1e-6},
                                         {"\xC2\xB5m", 1e-6},
                                         {"\xCE\xBCm", 1e-6},
                                         {"dm", 0.1},
                                         {"km", 1e3},
                                         {"in", 0.0254},
                                         {"ft", 0.3048}}};
constexpr std::array<Unit, 7> kTimes{
    {{"s", 1.0}, {"sec", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"\xC2\xB5s", 1e-6}, {"\xCE\xBCs", 1e-6}, {"min", 60.0}}};

template <std::size_t N>
std::optional<double> factor(const std::array<Unit, N>& units, std::string_view unit) {
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& of) { return of.first == unit; });
  if (found == units.end()) return {};
  return found->second;
}

std::string_view trimmed(std::string_view text) {
  const std::string_view blanks = " \t,:";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool speaks_of_a_run(std::string_view field) {
  static constexpr std::array<std::string_view, 7> kWords{"run", "set", "latest", "trial", "versuch", "lauf", "serie"};
  const std::string text = lower(field);
  return std::any_of(kWords.begin(), kWords.end(), [&](std::string_view word) { return text.starts_with(word); });
}

bool looks_like_a_unit(std::string_view field) {
  if (metres_per(field) || seconds_per(field)) return true;
  // m/s, m/s^2, m/s², N, 1, °: short and with no name of a quantity.
  const auto slash = field.find('/');
  if (slash != std::string_view::npos) return metres_per(field.substr(0, slash)).has_value() || field.size() <= 6;
  return field == "N" || field == "kg" || field == "V" || field == "rad" || field == "deg" || field == "Hz";
}

template <typename Predicate>
bool all_that_is_there(const std::vector<std::string>& fields, Predicate predicate) {
  bool any = false;
  for (const std::string& field : fields) {
    if (field.empty()) continue;
    if (!predicate(field)) return false;
    any = true;
  }
  return any;
}

/// "Run 1: Time (s)", "Time (s) Run #1", "Position, Run #2 (m)", "x_cm".
TableColumn column_of(const std::string& text) {
  TableColumn column;
  column.text = text;
  std::string_view rest = text;
  const auto open = rest.find_last_of("([");
  const auto close = open == std::string_view::npos ? open : rest.find_first_of(")]", open);
  std::string name(rest);
  if (close != std::string_view::npos) {
    column.unit = std::string(trimmed(rest.substr(open + 1, close - open - 1)));
    column.run = std::string(trimmed(rest.substr(close + 1)));
    name = std::string(trimmed(rest.substr(0, open)));
  }
  if (const auto colon = name.find(':'); colon != std::string::npos) {
    column.run = std::string(trimmed(std::string_view(name).substr(0, colon)));
    name = std::string(trimmed(std::string_view(name).substr(colon + 1)));
  }
  const std::string small = lower(name);
  for (const char* const mark : {", run", " run #", " run "}) {
    const auto at = small.find(mark);
    if (at == std::string::npos || at == 0) continue;
    column.run = std::string(trimmed(std::string_view(name).substr(at)));
    name = std::string(trimmed(std::string_view(name).substr(0, at)));
    break;
  }
  const auto underscore = name.rfind('_');
  if (column.unit.empty() && underscore != std::string::npos && underscore > 0) {
    const std::string_view tail = std::string_view(name).substr(underscore + 1);
    if (metres_per(tail) || seconds_per(tail)) {
      column.unit = std::string(tail);
      name.resize(underscore);
    }
  }
  column.name = name;
  return column;
}

}  // namespace

std::optional<double> metres_per(std::string_view unit) {
  return factor(kLengths, unit);
}

std::optional<double> seconds_per(std::string_view unit) {
  return factor(kTimes, unit);
}

std::vector<TableColumn> columns_of_header(const std::vector<std::vector<std::string>>& lines, std::size_t width) {
  auto header = lines;
  std::vector<std::string> runs, units;
  if (header.size() > 1 && all_that_is_there(header.front(), speaks_of_a_run)) {
    runs = header.front();
    header.erase(header.begin());
  }
  if (header.size() > 1 && all_that_is_there(header.back(), looks_like_a_unit)) {
    units = header.back();
    header.pop_back();
  }
  std::vector<TableColumn> columns;
  std::string run;
  for (std::size_t c = 0; c < width; ++c) {
    const bool named = !header.empty() && c < header.front().size() && !header.front()[c].empty();
    columns.push_back(column_of(named ? header.front()[c] : fmt::format("column {}", c + 1)));
    if (c < runs.size() && !runs[c].empty()) run = runs[c];  // one word over several columns
    if (columns.back().run.empty()) columns.back().run = run;
    if (c < units.size() && columns.back().unit.empty()) columns.back().unit = units[c];
  }
  return columns;
}

}  // namespace glidelab::core
