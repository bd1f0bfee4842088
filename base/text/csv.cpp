#include "base/text/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/readable_text.h"

namespace glidelab::base {
namespace {

constexpr std::size_t kMaxIssues = 10;  // a file of the wrong kind is wrong on every line

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t from = 0;;) {
    const auto comma = line.find(',', from);
    fields.push_back(trimmed(line.substr(from, comma - from)));
    if (comma == std::string_view::npos) return fields;
    from = comma + 1;
  }
}

bool parse_number(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && !text.empty();
}

/// What the last digit of a number is worth: 0.001 for "2.310", 1e-5 for "2.31e-3".
double worth_of_last_digit(std::string_view number) {
  const std::size_t power = std::min(number.find_first_of("eE"), number.size());
  const std::size_t point = number.find('.');
  double exponent = 0.0;  // a zero may have any: "0.0e-99999999999"
  if (power < number.size()) {
    std::string_view text = number.substr(power + 1);
    if (text.starts_with('+')) text.remove_prefix(1);
    std::from_chars(text.data(), text.data() + text.size(), exponent);
  }
  if (point < power) exponent -= static_cast<double>(power - point) - 1.0;
  return std::pow(10.0, exponent);
}

}  // namespace

bool CsvTable::has(std::string_view name) const {
  return std::find(header.begin(), header.end(), name) != header.end();
}

std::size_t CsvTable::place(std::string_view name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) throw InputError(Issue{file, 1, "header", "no column of this name", std::string(name)});
  return static_cast<std::size_t>(found - header.begin());
}

CsvTable read_csv(const std::filesystem::path& path, const std::vector<std::string>& wanted,
                  const std::vector<std::string>& optional, bool allow_others) {
  const std::string text = read_file(path);
  CsvTable table;
  table.file = path.string();
  std::vector<Issue> issues;
  std::vector<bool> skip;  // per field of the file
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  bool header_read = false;
  for (int line_number = 1; !rest.empty() && issues.size() < kMaxIssues; ++line_number) {
    const auto newline = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, newline));
    rest.remove_prefix(newline == std::string_view::npos ? rest.size() : newline + 1);
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = split(line);
    if (!header_read) {
      header_read = true;
      for (const std::string_view field : fields) {
        if (issues.size() >= kMaxIssues) break;
        const std::string name(field);
        const bool known = std::find(wanted.begin(), wanted.end(), name) != wanted.end() ||
                           std::find(optional.begin(), optional.end(), name) != optional.end();
        if (!known && !allow_others) {
          issues.push_back({table.file, line_number, "header", fmt::format("an unknown column \"{}\"", name),
                            fmt::format("the columns {}", fmt::join(wanted, ","))});
        } else if (known && table.has(name)) {
          issues.push_back({table.file, line_number, "header", fmt::format("column \"{}\" twice", name), "it once"});
        }
        skip.push_back(!known);
        if (known) table.header.push_back(name);
      }
      for (const std::string& name : wanted) {
        if (!table.has(name)) {
          issues.push_back({table.file, line_number, "header", fmt::format("no column \"{}\"", name),
                            fmt::format("the columns {}", fmt::join(wanted, ","))});
        }
      }
      if (!issues.empty()) break;
      table.columns.resize(table.header.size());
      table.last_digit.resize(table.header.size(), std::numeric_limits<double>::infinity());
      continue;
    }
    if (fields.size() != skip.size()) {
      const bool comma_decimals = fields.size() == 2 * skip.size() || line.find(';') != std::string_view::npos;
      issues.push_back({table.file, line_number, "",
                        fmt::format("{} fields{}", fields.size(), comma_decimals ? " (decimal commas?)" : ""),
                        fmt::format("{} fields, numbers with a decimal point", skip.size())});
      continue;
    }
    std::size_t column = 0;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (skip[f]) continue;
      double value = std::numeric_limits<double>::quiet_NaN();
      if (!parse_number(fields[f], value) || !std::isfinite(value)) {
        issues.push_back({table.file, line_number, fmt::format("column \"{}\"", table.header[column]),
                          fmt::format("\"{}\"", fields[f]), "a finite number with a decimal point"});
      }
      table.last_digit[column] = std::min(table.last_digit[column], worth_of_last_digit(fields[f]));
      table.columns[column++].push_back(value);
    }
    table.line.push_back(line_number);
  }
  if (!header_read) issues.push_back({table.file, 0, "", "no header", fmt::format("{}", fmt::join(wanted, ","))});
  if (!issues.empty()) throw InputError(std::move(issues));
  return table;
}

CsvWriter::CsvWriter(std::string_view header) : text_(header) {
  text_ += '\n';
}

void CsvWriter::separate() {
  if (row_started_) text_ += ',';
  row_started_ = true;
}

CsvWriter& CsvWriter::number(double value) {
  assert(std::isfinite(value));
  separate();
  text_ += fmt::format("{}", value);
  return *this;
}

CsvWriter& CsvWriter::text(std::string_view value) {
  assert(value.find_first_of(",\"\n") == std::string_view::npos);
  separate();
  text_ += value;
  return *this;
}

CsvWriter& CsvWriter::empty() {
  separate();
  return *this;
}

void CsvWriter::end_row() {
  text_ += '\n';
  row_started_ = false;
}

}  // namespace glidelab::base
