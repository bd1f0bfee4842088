#include "core/track/column_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "core/track/column_header.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kMostFieldIssues = 10;

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \r") - first + 1);
}

/// A field without blanks and quotes around it.
std::string_view field_text(std::string_view field) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '"'; };
  while (!field.empty() && blank(field.front())) field.remove_prefix(1);
  while (!field.empty() && blank(field.back())) field.remove_suffix(1);
  return field;
}

/// A delimiter within quotes is none.
std::vector<std::string_view> split(std::string_view line, char delimiter) {
  std::vector<std::string_view> fields;
  std::size_t from = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != delimiter)) continue;
    fields.push_back(field_text(line.substr(from, i - from)));
    from = i + 1;
  }
  return fields;
}

struct Format {
  char delimiter = ',';
  char decimal = '.';
};

bool is_missing(std::string_view field) {
  return field.empty() || field == "NaN" || field == "nan" || field == "NAN";
}

std::optional<double> number(std::string_view field, char decimal) {
  std::string text(field);
  if (decimal == ',') {
    if (text.find('.') != std::string::npos) return {};
    std::replace(text.begin(), text.end(), ',', '.');
  }
  const char* first = text.data();
  if (text.starts_with("+")) ++first;
  double value = 0.0;
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// Numbers or nothing in all fields, and two numbers or more.
bool is_data(const std::vector<std::string_view>& fields, char decimal) {
  int numbers = 0;
  for (const std::string_view field : fields) {
    if (is_missing(field)) continue;
    if (!number(field, decimal)) return false;
    ++numbers;
  }
  return numbers >= 2;
}

struct Line {
  int number = 0;
  std::string_view text;
};

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  for (int at = 1; !text.empty(); ++at) {
    const auto newline = text.find('\n');
    const std::string_view line = trim(text.substr(0, newline));
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    if (line.find_first_not_of("\t;, ") != std::string_view::npos && line.front() != '#') lines.push_back({at, line});
  }
  return lines;
}

/// Nothing where no line holds two numbers.
std::optional<Format> format_of(const std::vector<Line>& lines) {
  std::optional<Format> best;
  std::size_t most = 0;
  for (const Format& format :
       {Format{'\t', '.'}, Format{'\t', ','}, Format{';', '.'}, Format{';', ','}, Format{',', '.'}}) {
    std::size_t count = 0;
    for (const Line& line : lines) count += is_data(split(line.text, format.delimiter), format.decimal);
    if (count > most) {
      most = count;
      best = format;
    }
  }
  return best;
}

}  // namespace

ColumnTable read_column_table(const std::filesystem::path& file) {
  const std::string text = base::read_file(file);
  ColumnTable table;
  table.file = file.string();
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  if (rest.find('\0') != std::string_view::npos) {
    throw base::InputError(base::Issue{table.file, 0, "", "zero bytes (UTF-16, or no text)",
                                       "text in UTF-8 with a track; a video goes into a folder, which glidelab new "
                                       "FOLDER makes"});
  }
  const std::vector<Line> lines = lines_of(rest);
  const auto format = format_of(lines);
  if (!format) {
    throw base::InputError(base::Issue{table.file, 0, "", "no line with two numbers",
                                       "columns of numbers, with tabs, semicolons or commas between them"});
  }
  std::vector<std::vector<std::string_view>> rows;
  for (const Line& line : lines) rows.push_back(split(line.text, format->delimiter));
  const auto first_data = static_cast<std::size_t>(
      std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return is_data(row, format->decimal); }) -
      rows.begin());
  std::size_t width = 0;
  for (std::size_t r = first_data; r < rows.size(); ++r) width = std::max(width, rows[r].size());

  std::vector<std::vector<std::string>> header;
  for (std::size_t r = 0; r < first_data; ++r) {
    if (rows[r].size() < 2) continue;  // a title
    header.emplace_back(rows[r].begin(), rows[r].end());
  }
  table.has_header = !header.empty();
  table.columns = columns_of_header(header, width);

  std::vector<base::Issue> issues;
  if (table.has_header && header.back().size() < width) {
    const bool ambiguous = format->delimiter == ',';
    issues.push_back({table.file, lines[first_data].number, "",
                      fmt::format("{} numbers under {} names", width, header.back().size()),
                      ambiguous ? "one for each name (a decimal comma needs another delimiter than the comma)"
                                : "one for each name"});
  }
  for (std::size_t r = first_data; r < rows.size() && issues.size() < kMostFieldIssues; ++r) {
    table.line.push_back(lines[r].number);
    for (std::size_t c = 0; c < width; ++c) {
      const std::string_view field = c < rows[r].size() ? rows[r][c] : std::string_view{};
      std::optional<double> value;
      if (!is_missing(field)) {
        value = number(field, format->decimal);
        if (!value) {
          issues.push_back({table.file, lines[r].number, fmt::format("column {}", c + 1), fmt::format("\"{}\"", field),
                            fmt::format("a number with a decimal {}", format->decimal == ',' ? "comma" : "point")});
        }
      }
      table.columns[c].values.push_back(value);
    }
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  return table;
}

}  // namespace glidelab::core
