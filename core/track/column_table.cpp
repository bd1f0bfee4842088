#include "core/track/column_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/readable_text.h"
#include "core/track/number_field.h"
#include "core/track/stacked_runs.h"
#include "core/track/text_encoding.h"
#include "core/track/workbook.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kMostFieldIssues = 10;

/// Of a line: tabs may separate its columns.
std::string_view trimmed_line(std::string_view text) {
  return base::trimmed(text, " \r");
}

constexpr char kOfColumn = '?';  // as a decimal sign: each column has its own
constexpr std::array kDelimiters = {'\t', ';', ',', kBlanks};

struct Format {
  char delimiter = ',';
  char decimal = '.';
};

Thousands thousands_of(const Format& format) {
  return format.delimiter == ',' ? Thousands::without_plain_blanks : Thousands::with_blanks;
}

using Fields = std::vector<std::string_view>;

/// Or a time of day, which counts as one.
bool is_number(std::string_view field, const Format& format) {
  if (clock_time_in(field)) return true;
  return format.decimal == kOfColumn ? number_in(field, '.') || number_in(field, ',')
                                     : number_in(field, format.decimal, thousands_of(format)).has_value();
}

/// Numbers or nothing in all fields, and two numbers or more.
bool is_data(const Fields& fields, const Format& format) {
  int numbers = 0;
  for (const std::string_view field : fields) {
    if (is_missing(field)) continue;
    if (!is_number(field, format)) return false;
    ++numbers;
  }
  return numbers >= 2;
}

/// Which columns hold numbers rather than text in the lines that have two numbers or more: not those of remarks.
std::vector<bool> columns_of_numbers(const std::vector<Fields>& rows, const Format& format) {
  std::vector<long> more_numbers;
  for (const Fields& row : rows) {
    std::vector<int> kinds;  // 1 a number, -1 text
    for (const std::string_view field : row) kinds.push_back(is_missing(field) ? 0 : is_number(field, format) ? 1 : -1);
    if (std::ranges::count(kinds, 1) < 2) continue;
    more_numbers.resize(std::max(more_numbers.size(), kinds.size()), 0);
    for (std::size_t c = 0; c < kinds.size(); ++c) more_numbers[c] += kinds[c];
  }
  std::vector<bool> of_numbers;
  for (const long more : more_numbers) of_numbers.push_back(more > 0);
  return of_numbers;
}

/// Two numbers or more, and no text, in the columns of numbers.
bool is_data_among(const Fields& fields, const Format& format, const std::vector<bool>& of_numbers) {
  int numbers = 0;
  for (std::size_t c = 0; c < std::min(fields.size(), of_numbers.size()); ++c) {
    if (!of_numbers[c] || is_missing(fields[c])) continue;
    if (!is_number(fields[c], format)) return false;
    ++numbers;
  }
  return numbers >= 2;
}

struct Line {
  int number = 0;
  std::string_view text;
};

struct Lines {
  std::vector<Line> all;
  std::vector<Line> comments;  ///< the text after the '#'
};

/// A table pasted into the first column of a spreadsheet is saved with each of its lines in quotes.
std::string_view without_line_quotes(std::string_view line) {
  const bool quoted = line.size() > 2 && line.front() == '"' && line.find('"', 1) == line.size() - 1;
  return quoted && line.find_first_of("\t;") != std::string_view::npos ? line.substr(1, line.size() - 2) : line;
}

Lines lines_of(std::string_view text) {
  Lines lines;
  for (int at = 1; !text.empty(); ++at) {
    const auto newline = text.find('\n');
    const std::string_view line = without_line_quotes(trimmed_line(text.substr(0, newline)));
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    if (line.find_first_not_of("\t;, ") == std::string_view::npos) continue;
    if (line.front() == '#') {
      lines.comments.push_back({at, trimmed_line(line.substr(1))});
    } else {
      lines.all.push_back({at, line});
    }
  }
  return lines;
}

/// The header after a '#': of the comments before the numbers, the last with as many fields as the numbers have and, if
/// it holds units, also the names before it. Empty if there is none.
std::vector<std::vector<std::string>> commented_header(const std::vector<Line>& comments, int first_data,
                                                       std::size_t width, const Format& format) {
  std::vector<std::vector<std::string>> lines;
  for (const Line& comment : comments) {
    if (comment.number > first_data) break;
    const std::vector<std::string_view> fields = split_fields(comment.text, format.delimiter);
    if (fields.size() != width || is_data(fields, format)) continue;
    lines.emplace_back(fields.begin(), fields.end());
  }
  const std::size_t wanted = !lines.empty() && holds_units(lines.back()) ? 2 : 1;
  if (lines.size() > wanted) lines.erase(lines.begin(), lines.end() - static_cast<std::ptrdiff_t>(wanted));
  return lines;
}

/// The decimal sign of each column, from the lines that are data.
std::vector<DecimalSign> signs_of(const std::vector<Line>& lines, const Format& format) {
  std::vector<DecimalSign> signs;
  for (const Line& line : lines) {
    const auto fields = split_fields(line.text, format.delimiter);
    if (!is_data(fields, format)) continue;
    if (signs.size() < fields.size()) signs.resize(fields.size());
    for (std::size_t c = 0; c < fields.size(); ++c) signs[c].see(fields[c]);
  }
  return signs;
}

/// Empty if no line holds two numbers. Signs that differ from column to column count only where the fields cannot be
/// read otherwise, and not where they differ within a column.
std::optional<Format> format_of(const std::vector<Line>& lines) {
  // Two commas: with quotes around each number that has one.
  constexpr std::array kFormats = {
      Format{'\t', '.'},    Format{'\t', ','},    Format{';', '.'}, Format{';', ','},        Format{',', '.'},
      Format{kBlanks, '.'}, Format{kBlanks, ','}, Format{',', ','}, Format{'\t', kOfColumn}, Format{';', kOfColumn}};
  std::array<std::size_t, kFormats.size()> counts = {};
  for (const Line& line : lines) {
    for (const char delimiter : kDelimiters) {
      const Fields fields = split_fields(line.text, delimiter);
      for (std::size_t f = 0; f < kFormats.size(); ++f) {
        if (kFormats[f].delimiter == delimiter) counts[f] += is_data(fields, kFormats[f]);
      }
    }
  }
  std::optional<Format> best;
  std::size_t most = 0;
  const auto differ = [](const DecimalSign& sign) { return sign.points && sign.commas; };
  for (std::size_t f = 0; f < kFormats.size(); ++f) {
    const Format& format = kFormats[f];
    if (counts[f] > most && (format.decimal != kOfColumn || std::ranges::none_of(signs_of(lines, format), differ))) {
      most = counts[f];
      best = format;
    }
  }
  return best;
}

/// A label, a mark or a remark; no date that was a number, and no number with another decimal sign or with signs
/// between its thousands.
bool is_words(std::string_view field) {
  return !number_in(field, '.') && !number_in(field, ',') && !is_month_and_number(field) &&
         field.find_first_not_of("0123456789.,+-' ") != std::string_view::npos;
}

/// Whether all fields outside the columns of numbers are dates or words; between blanks, words behind the last number
/// only.
bool has_words_besides(const Fields& fields, const Format& format, const std::vector<bool>& of_numbers) {
  bool after_words = false;
  for (std::size_t c = 0; c < fields.size(); ++c) {
    const bool number_here = c < of_numbers.size() && of_numbers[c];
    if (number_here && after_words && format.delimiter == kBlanks) return false;
    if (number_here || is_missing(fields[c]) || is_date(fields[c])) continue;
    if (!is_words(fields[c])) return false;
    after_words = true;
  }
  return true;
}

/// For a table with text in each line, as in a column of labels: most lines have numbers in the same columns, and words
/// in the others. Of the formats with which that is so for the same number of lines, the one that reads most numbers.
std::optional<Format> format_with_text(const std::vector<Line>& lines) {
  constexpr std::size_t kFewest = 5;  // lines with numbers, which are most of all
  std::optional<Format> best;
  std::pair<std::size_t, std::size_t> most{std::max(kFewest, lines.size() / 2 + 1), 0};
  for (const char delimiter : kDelimiters) {
    std::vector<Fields> rows;
    for (const Line& line : lines) rows.push_back(split_fields(line.text, delimiter));
    for (const char decimal : {'.', ','}) {
      const Format format{delimiter, decimal};
      const std::vector<bool> of_numbers = columns_of_numbers(rows, format);
      std::pair<std::size_t, std::size_t> found{0, 0};
      for (const Fields& row : rows) {
        if (!is_data_among(row, format, of_numbers) || !has_words_besides(row, format, of_numbers)) continue;
        ++found.first;
        found.second += static_cast<std::size_t>(
            std::ranges::count_if(row, [&](std::string_view field) { return is_number(field, format); }));
      }
      if (found <= most) continue;
      most = found;
      best = format;
    }
  }
  return best;
}

bool has_digit(std::string_view text) {
  return text.find_first_of("0123456789") != std::string_view::npos;
}

/// Why no line of the file is read, with the line that a reader should look at.
base::Issue no_numbers(const std::string& file, const std::vector<Line>& lines) {
  const auto numbers_of = [](const Line& line, char decimal) {
    std::size_t most = 0;
    for (const char delimiter : {'\t', ';', kBlanks}) {
      const auto fields = split_fields(line.text, delimiter);
      most = std::max(most, static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), [&](auto field) {
                        return field.find(decimal) != std::string_view::npos && number_in(field, decimal);
                      })));
    }
    return most;
  };
  base::Issue issue{file, 0, "", "no line with two numbers",
                    "columns of numbers, with tabs, semicolons, commas or blanks between them"};
  const Line* shown = nullptr;
  bool dates = false, both_signs = false;
  for (const Line& line : lines) {
    if (shown == nullptr && has_digit(line.text)) shown = &line;
    for (const std::string_view field : split_fields(line.text, ';')) dates |= is_month_and_number(field);
    both_signs |= numbers_of(line, '.') > 0 && numbers_of(line, ',') > 0;
  }
  if (shown == nullptr) return issue;
  constexpr std::size_t kMostShown = 60;
  issue.line = shown->number;
  issue.found = fmt::format("no line with two numbers; the first with digits is {}{}",
                            base::first_bytes(shown->text, kMostShown), shown->text.size() > kMostShown ? "…" : "");
  if (dates) {
    issue.expected +=
        "; a spreadsheet has turned some of these numbers into dates: export them again from the program "
        "that measured them";
  } else if (both_signs) {
    issue.expected +=
        "; decimal points and decimal commas do not go together in one column, and only semicolons or "
        "tabs tell columns of different signs apart";
  }
  return issue;
}

/// In a table with both decimal signs, a column in which one of them may be neither.
base::Issue thousands_or_decimals(const ColumnTable& table, std::size_t column, const DecimalSign& sign, int line) {
  const char* const name = sign.commas ? "comma" : "point";
  return {
      table.file, line, fmt::format("column \"{}\"", table.columns[column].text),
      fmt::format("numbers such as {}, and the other decimal sign in another column", sign.example),
      fmt::format("one decimal sign in the whole file: with three digits after each {0}, it may be a decimal {0} or "
                  "stand between thousands",
                  name)};
}

/// Numbers, some of which have another decimal sign than those below: a row of data above the first that is read, and
/// no header.
bool is_row_of_other_sign(const Fields& row, const Format& format) {
  const bool all =
      std::ranges::all_of(row, [](std::string_view field) { return number_in(field, '.') || number_in(field, ','); });
  return all && std::ranges::any_of(row, [&](std::string_view field) { return !is_number(field, format); });
}

/// A number, and nothing else: a row of data without its other values.
bool is_incomplete(const Fields& row, const Format& format) {
  const auto missing = std::ranges::count_if(row, is_missing);
  const auto numbers = std::ranges::count_if(row, [&](std::string_view field) { return is_number(field, format); });
  return numbers == 1 && missing > 0 && static_cast<std::size_t>(numbers + missing) == row.size();
}

base::Issue other_sign(const std::string& file, const Line& line, const Format& format) {
  return {file, line.number, "", fmt::format("\"{}\", with another decimal sign than the rows below", line.text),
          fmt::format("a decimal {} throughout", format.decimal == ',' ? "comma" : "point")};
}

/// Of each column: rows with a time of day, and with a plain number.
struct ClockFields {
  std::vector<std::size_t> rows;
  std::size_t numbers = 0;
};

/// Times of day become seconds from the first of them, where all of a column are that and no other column holds times.
/// Elsewhere they are no values, as other text. Whether they are the times of the table.
bool count_times_of_day(ColumnTable& table, const std::vector<ClockFields>& fields) {
  std::vector<bool> of_clock;
  for (std::size_t c = 0; c < fields.size(); ++c) {
    TableColumn& column = table.columns[c];
    of_clock.push_back(!fields[c].rows.empty() && fields[c].numbers == 0);
    if (of_clock.back()) continue;
    for (const std::size_t row : fields[c].rows) {
      column.values[row].reset();
      if (column.texts.size() >= kMostFieldIssues) continue;
      column.texts.push_back({table.file, table.line[row], fmt::format("column {}", c + 1), "a time of day",
                              "a number, as in the other rows"});
    }
  }
  bool others = false, any = false;
  for (std::size_t c = 0; c < of_clock.size(); ++c)
    others = others || (!of_clock[c] && is_time_column(table.columns[c]));
  for (std::size_t c = 0; c < of_clock.size(); ++c) {
    TableColumn& column = table.columns[c];
    if (!of_clock[c]) continue;
    if (others) {
      std::ranges::fill(column.values, std::nullopt);
      column.unit = "time of day";  // no unit of times, whatever the name
    } else {
      count_from_first(column.values);
      column.unit = "s";
      any = true;
    }
  }
  return any;
}

/// A delimiter at the end of each line makes a column without a name and without values.
void drop_empty_columns_at_end(ColumnTable& table) {
  const auto is_empty = [&](const TableColumn& column) {
    return column.text == fmt::format("column {}", table.columns.size()) &&
           std::none_of(column.values.begin(), column.values.end(),
                        [](const auto& value) { return value.has_value(); });
  };
  while (!table.columns.empty() && is_empty(table.columns.back())) table.columns.pop_back();
}

}  // namespace

ColumnTable read_column_table(const std::filesystem::path& file) {
  if (is_spreadsheet(file)) {
    const SheetText sheet = read_sheet(file);
    ColumnTable table = table_of_text(sheet.text, sheet.shown_as);
    table.sheet = sheet.sheet;
    table.dates = sheet.dates;
    return table;
  }
  const std::string bytes = base::read_file(file);
  const std::string name = file.string();
  const NoTable other = no_table_in(bytes);
  if (!other.what.empty()) throw base::InputError(base::Issue{name, 0, "", other.what, other.advice});
  const std::string text = as_utf8(bytes);
  if (text.find('\0') != std::string::npos) {
    throw base::InputError(base::Issue{name, 0, "", "zero bytes (UTF-16 without a byte-order mark, or no text)",
                                       "text in UTF-8 with a track; a video goes into a folder, which glidelab new "
                                       "FOLDER makes"});
  }
  return table_of_text(text, name);
}

ColumnTable table_of_text(std::string_view text, const std::string& name) {
  ColumnTable table;
  table.file = name;
  const Lines read = lines_of(text);
  const std::vector<Line>& lines = read.all;
  auto format = format_of(lines);
  if (!format) format = format_with_text(lines);
  if (!format) {
    throw base::InputError(no_numbers(table.file, lines));
  }
  std::vector<std::vector<std::string_view>> rows;
  for (const Line& line : lines) rows.push_back(split_fields(line.text, format->delimiter));
  const std::vector<bool> of_numbers = columns_of_numbers(rows, *format);
  const auto first_data = static_cast<std::size_t>(
      std::ranges::find_if(rows, [&](const Fields& row) { return is_data_among(row, *format, of_numbers); }) -
      rows.begin());
  std::size_t width = 0, widest = first_data;
  for (std::size_t r = first_data; r < rows.size(); ++r) {
    if (rows[r].size() <= width) continue;
    width = rows[r].size();
    widest = r;
  }
  // Each line has a value in each column, so that one long line makes many of a short file.
  if (width > kMostFields / (rows.size() - first_data)) {
    throw base::InputError(base::Issue{table.file, lines[widest].number, "",
                                       fmt::format("{} columns, in {} lines", width, rows.size() - first_data),
                                       fmt::format("at most {} million fields in all", kMostFields / 1'000'000)});
  }

  std::vector<base::Issue> issues;
  std::vector<std::vector<std::string>> header;
  for (std::size_t r = 0; r < first_data; ++r) {
    if (rows[r].size() < 2 || is_incomplete(rows[r], *format)) continue;  // a title; times before anything is seen
    if (is_row_of_other_sign(rows[r], *format)) issues.push_back(other_sign(table.file, lines[r], *format));
    const bool as_wide = rows[r].size() == width || rows[r].size() == rows[first_data].size();
    if (format->delimiter == kBlanks && !as_wide) continue;  // words of a title
    header.emplace_back(rows[r].begin(), rows[r].end());
  }
  if (header.empty()) header = commented_header(read.comments, lines[first_data].number, width, *format);
  table.has_header = !header.empty();
  const auto ends_without = [&](const auto& row) {
    return row.size() < width || is_missing(row[width - 1]) || !is_number(row[width - 1], *format);
  };
  while (table.has_header && width > header.back().size() &&
         std::all_of(rows.begin() + static_cast<long>(first_data), rows.end(), ends_without)) {
    --width;  // data rows that end in a delimiter or a remark
  }
  table.columns = columns_of_header(header, width);

  std::vector<char> decimals(width, format->decimal);
  if (format->decimal == kOfColumn) {
    const std::vector<DecimalSign> signs = signs_of(lines, *format);
    for (std::size_t c = 0; c < width; ++c) {
      const DecimalSign sign = c < signs.size() ? signs[c] : DecimalSign{};
      decimals[c] = sign.commas ? ',' : '.';
      if (sign.may_be_thousands()) issues.push_back(thousands_or_decimals(table, c, sign, lines[first_data].number));
    }
  }
  if (table.has_header && header.back().size() < width) {
    const bool ambiguous = format->delimiter == ',';
    issues.push_back({table.file, lines[first_data].number, "",
                      fmt::format("{} numbers under {} names", width, header.back().size()),
                      ambiguous ? "one for each name (a decimal comma needs another delimiter than the comma)"
                                : "one for each name"});
  }
  std::vector<ClockFields> clock(width);
  for (std::size_t r = first_data; r < rows.size(); ++r) {
    table.line.push_back(lines[r].number);
    for (std::size_t c = 0; c < width; ++c) {
      const std::string_view field = c < rows[r].size() ? rows[r][c] : std::string_view{};
      std::optional<double> value;
      if (!is_missing(field)) {
        value = number_in(field, decimals[c], thousands_of(*format));
        clock[c].numbers += value ? 1 : 0;
        if (!value && (value = clock_time_in(field))) clock[c].rows.push_back(table.columns[c].values.size());
        std::vector<base::Issue>& texts = table.columns[c].texts;
        if (!value && texts.size() < kMostFieldIssues) {
          texts.push_back({table.file, lines[r].number, fmt::format("column {}", c + 1), fmt::format("\"{}\"", field),
                           fmt::format("a number with a decimal {}", decimals[c] == ',' ? "comma" : "point")});
        }
      }
      table.columns[c].values.push_back(value);
    }
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  const bool times_of_day = count_times_of_day(table, clock);
  drop_empty_columns_at_end(table);
  put_side_by_side(table, times_of_day);
  return table;
}

base::InputError wrong_column(const ColumnTable& table, const std::string& found, const std::string& expected) {
  return base::InputError(base::Issue{table.file, 0, "column", found, expected});
}

}  // namespace glidelab::core
