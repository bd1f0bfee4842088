/// Comma-separated tables of numbers with a header line; lines that start with '#' are comments.
///
/// Lines may end with LF or CRLF, and the file may start with a UTF-8 byte-order mark. A decimal comma shows up as a
/// wrong number of fields, and the message says so.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::base {

struct CsvTable {
  std::string file;
  std::vector<std::string> header;
  std::vector<std::vector<double>> columns;  ///< columns[c][row], all of one length; every value finite
  std::vector<double> last_digit;            ///< per column: the smallest value of a last digit, 0.001 for "2.310"
  std::vector<int> line;                     ///< line[row], 1-based

  bool has(std::string_view name) const;
  /// The column of this name; InputError if there is none.
  const std::vector<double>& column(std::string_view name) const { return columns[place(name)]; }
  double last_digit_of(std::string_view name) const { return last_digit[place(name)]; }

 private:
  std::size_t place(std::string_view name) const;
};

/// Reads the columns named in `wanted` (required) and `optional`; other columns are ignored if `allow_others`, errors
/// otherwise. InputError (up to ten issues, with line and column) for anything that is not a finite number.
CsvTable read_csv(const std::filesystem::path& path, const std::vector<std::string>& wanted,
                  const std::vector<std::string>& optional = {}, bool allow_others = false);

/// Builds a table line by line in memory. Each number is the shortest text that reads back as the same double.
class CsvWriter {
 public:
  explicit CsvWriter(std::string_view header);
  CsvWriter& number(double value);          ///< appends a field; NaN and infinity are a programmer's mistake
  CsvWriter& text(std::string_view value);  ///< appended as it stands; must hold no comma, quote or newline
  CsvWriter& empty();
  void end_row();
  const std::string& str() const { return text_; }

 private:
  void separate();
  std::string text_;
  bool row_started_ = false;
};

}  // namespace glidelab::base
