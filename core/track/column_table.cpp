#include "core/track/column_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/file_names.h"
#include "core/track/number_field.h"
#include "core/track/table_columns.h"
#include "core/track/text_encoding.h"
#include "core/track/workbook.h"

namespace glidelab::core {
namespace {

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

/// "[s]" in a line of units is "s".
std::string_view without_brackets(std::string_view field) {
  const bool bracketed = field.size() > 2 && (field.front() == '[' || field.front() == '(') &&
                         (field.back() == ']' || field.back() == ')');
  return bracketed ? trimmed(field.substr(1, field.size() - 2)) : field;
}

bool looks_like_a_unit(std::string_view field) {
  if (without_brackets(field).size() < field.size()) return true;
  if (metres_per(field) || seconds_per(field)) return true;
  // m/s, m/s^2, m/s², N, 1, °: short and without the name of a quantity.
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
  // The channel distinguishes several sensors: "Position, Ch 1 (m)".
  if (const auto channel = small.find(", ch "); channel != std::string::npos && channel > 0) {
    std::string_view rest_of = std::string_view(name).substr(channel + 2);
    const auto run = lower(rest_of).find(", run");
    column.run = std::string(trimmed(run == std::string::npos ? rest_of : rest_of.substr(run)));
    name = std::string(trimmed(std::string_view(name).substr(0, channel)));
    column.name = name;
    return column;
  }
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
  // "x / cm", "t in s", "x, cm".
  for (const std::string_view between : {"/", " in ", ","}) {
    const auto at = name.rfind(between);
    if (!column.unit.empty() || at == std::string::npos || at == 0) continue;
    const std::string_view tail = trimmed(std::string_view(name).substr(at + between.size()));
    if (!metres_per(tail) && !seconds_per(tail)) continue;
    column.unit = std::string(tail);
    name = std::string(trimmed(std::string_view(name).substr(0, at)));
  }
  column.name = name;
  return column;
}

}  // namespace

bool is_time_name(std::string_view name) {
  static constexpr std::array<std::string_view, 13> kNames{"t",       "time",  "zeit",     "temps", "tiempo",
                                                           "tempo",   "tijd",  "czas",     "tid",   "elapsed time",
                                                           "seconds", "times", "timestamp"};
  return std::find(kNames.begin(), kNames.end(), lower(name)) != kNames.end();
}

bool is_time_column(const TableColumn& column) {
  return column.unit.empty() ? is_time_name(column.name) : seconds_per(column.unit).has_value();
}

bool is_place_column(const TableColumn& column) {
  static const std::vector<std::string> kPlaces{
      "x", "position", "pos", "distance", "displacement", "position x", "x-position", "position (x)",
      // German, Spanish, French, Italian, Portuguese
      "weg", "ort", "abstand", "strecke", "entfernung", "posici\xC3\xB3n", "posici\xC3\x93n", "posicion", "distancia",
      "desplazamiento", "d\xC3\xA9placement", "distance x", "x position", "pos x", "x pos", "pos_x", "x_pos",
      "posizione", "spostamento", "distanza", "posi\xC3\xA7\xC3\xA3o", "dist\xC3\xA2ncia", "deslocamento",
      // Norwegian, Danish, Swedish, Dutch
      "posisjon", "strekning", "avstand", "afstand", "str\xC3\xA6kning",
      "str\xC3\xA4"
      "cka",
      "avst\xC3\xA5nd", "positie"};
  return !is_time_column(column) && std::find(kPlaces.begin(), kPlaces.end(), lower(column.name)) != kPlaces.end();
}

bool is_height_column(const TableColumn& column) {
  static const std::vector<std::string> kHeights{
      "y",           "position y",        "y-position", "y position", "position (y)", "height",       "h",
      "h\xC3\xB6he", "hauteur",           "altura",     "altezza",    "h\xC3\xB8yde", "h\xC3\xB8jde", "h\xC3\xB6jd",
      "hoogte",      "vertical position", "z"};
  return !is_time_column(column) && std::find(kHeights.begin(), kHeights.end(), lower(column.name)) != kHeights.end();
}

namespace {

/// A line of names of bodies or runs above the column names, each spanning several columns: Tracker writes the mass
/// above its t, x and y and pads the line.
bool names_several_columns(const std::vector<std::string>& line, const std::vector<std::string>& below) {
  const auto filled = [](const std::vector<std::string>& fields) {
    return std::count_if(fields.begin(), fields.end(), [](const std::string& field) { return !field.empty(); });
  };
  const bool has_time = std::any_of(below.begin(), below.end(),
                                    [](const std::string& field) { return is_time_name(column_of(field).name); });
  return filled(line) > 0 && filled(line) < filled(below) && has_time &&
         !std::any_of(line.begin(), line.end(),
                      [](const std::string& field) { return is_time_name(column_of(field).name); });
}

}  // namespace

std::vector<TableColumn> columns_of_header(const std::vector<std::vector<std::string>>& lines, std::size_t width) {
  auto header = lines;
  std::vector<std::string> runs, units;
  if (header.size() > 1 &&
      (all_that_is_there(header.front(), speaks_of_a_run) || names_several_columns(header.front(), header[1]))) {
    runs = header.front();
    header.erase(header.begin());
  }
  if (header.size() > 1 && all_that_is_there(header.back(), looks_like_a_unit)) {
    units = header.back();
    header.pop_back();
  }
  // A title with as many words as columns.
  const auto names_time = [](const std::vector<std::string>& line) {
    return std::any_of(line.begin(), line.end(),
                       [](const std::string& field) { return is_time_column(column_of(field)); });
  };
  const auto names = std::find_if(header.begin(), header.end(), names_time);
  if (names != header.end()) header.erase(header.begin(), names);
  std::vector<TableColumn> columns;
  std::string run;
  for (std::size_t c = 0; c < width; ++c) {
    const bool named = !header.empty() && c < header.front().size() && !header.front()[c].empty();
    columns.push_back(column_of(named ? header.front()[c] : fmt::format("column {}", c + 1)));
    if (c < runs.size() && !runs[c].empty()) run = runs[c];  // one word above several columns
    if (columns.back().run.empty()) columns.back().run = run;
    if (c < units.size() && columns.back().unit.empty()) columns.back().unit = without_brackets(units[c]);
  }
  return columns;
}

namespace {

constexpr std::size_t kMostFieldIssues = 10;
constexpr std::size_t kMostFields = 100'000'000;  // 1.6 GB; a file of 1 GiB holds about 60 million of t and x

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \r") - first + 1);
}

constexpr char kOfColumn = '?';  // as a decimal sign: each column has its own

struct Format {
  char delimiter = ',';
  char decimal = '.';
};

Thousands thousands_of(const Format& format) {
  return format.delimiter == ',' ? Thousands::without_plain_blanks : Thousands::with_blanks;
}

/// Numbers or nothing in all fields, and two numbers or more.
bool is_data(const std::vector<std::string_view>& fields, const Format& format) {
  int numbers = 0;
  for (const std::string_view field : fields) {
    if (is_missing(field)) continue;
    const bool is_number = format.decimal == kOfColumn
                               ? number_in(field, '.') || number_in(field, ',')
                               : number_in(field, format.decimal, thousands_of(format)).has_value();
    if (!is_number) return false;
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
    const std::string_view line = without_line_quotes(trim(text.substr(0, newline)));
    text.remove_prefix(newline == std::string_view::npos ? text.size() : newline + 1);
    if (line.find_first_not_of("\t;, ") == std::string_view::npos) continue;
    if (line.front() == '#') {
      lines.comments.push_back({at, trim(line.substr(1))});
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
  const std::size_t wanted = !lines.empty() && all_that_is_there(lines.back(), looks_like_a_unit) ? 2 : 1;
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
  std::optional<Format> best;
  std::size_t most = 0;
  for (const Format& format : {Format{'\t', '.'}, Format{'\t', ','}, Format{';', '.'}, Format{';', ','},
                               Format{',', '.'}, Format{kBlanks, '.'}, Format{kBlanks, ','},
                               Format{',', ','},  // with quotes around each number that has a comma
                               Format{'\t', kOfColumn}, Format{';', kOfColumn}}) {
    std::size_t count = 0;
    for (const Line& line : lines) count += is_data(split_fields(line.text, format.delimiter), format);
    const auto differ = [](const DecimalSign& sign) { return sign.points && sign.commas; };
    if (count > most && (format.decimal != kOfColumn || std::ranges::none_of(signs_of(lines, format), differ))) {
      most = count;
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
  std::size_t most_shown = 60;
  const auto continues = [&](std::size_t at) { return (static_cast<unsigned char>(shown->text[at]) & 0xC0) == 0x80; };
  while (most_shown < shown->text.size() && continues(most_shown)) --most_shown;  // no character is cut in two
  issue.line = shown->number;
  issue.found = fmt::format("no line with two numbers; the first with digits is {}{}",
                            shown->text.substr(0, most_shown), shown->text.size() > most_shown ? "…" : "");
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
  const auto format = format_of(lines);
  if (!format) {
    throw base::InputError(no_numbers(table.file, lines));
  }
  std::vector<std::vector<std::string_view>> rows;
  for (const Line& line : lines) rows.push_back(split_fields(line.text, format->delimiter));
  const auto first_data = static_cast<std::size_t>(
      std::find_if(rows.begin(), rows.end(), [&](const auto& row) { return is_data(row, *format); }) - rows.begin());
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

  std::vector<std::vector<std::string>> header;
  for (std::size_t r = 0; r < first_data; ++r) {
    if (rows[r].size() < 2) continue;                                       // a title
    if (format->delimiter == kBlanks && rows[r].size() != width) continue;  // words of a title
    header.emplace_back(rows[r].begin(), rows[r].end());
  }
  if (header.empty()) header = commented_header(read.comments, lines[first_data].number, width, *format);
  table.has_header = !header.empty();
  const auto ends_empty = [&](const auto& row) { return row.size() < width || is_missing(row[width - 1]); };
  while (table.has_header && width > header.back().size() &&
         std::all_of(rows.begin() + static_cast<long>(first_data), rows.end(), ends_empty)) {
    --width;  // data rows that end in a delimiter
  }
  table.columns = columns_of_header(header, width);

  std::vector<base::Issue> issues;
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
  for (std::size_t r = first_data; r < rows.size() && issues.size() < kMostFieldIssues; ++r) {
    table.line.push_back(lines[r].number);
    for (std::size_t c = 0; c < width && issues.size() < kMostFieldIssues; ++c) {
      const std::string_view field = c < rows[r].size() ? rows[r][c] : std::string_view{};
      std::optional<double> value;
      if (!is_missing(field)) {
        value = number_in(field, decimals[c], thousands_of(*format));
        if (!value) {
          issues.push_back({table.file, lines[r].number, fmt::format("column {}", c + 1), fmt::format("\"{}\"", field),
                            fmt::format("a number with a decimal {}", decimals[c] == ',' ? "comma" : "point")});
        }
      }
      table.columns[c].values.push_back(value);
    }
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  drop_empty_columns_at_end(table);
  return table;
}

}  // namespace glidelab::core
