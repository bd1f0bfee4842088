#include "core/track/workbook.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "core/experiment/file_names.h"
#include "core/track/container/xml_document.h"
#include "core/track/container/zip_archive.h"
#include "core/track/number_field.h"

namespace glidelab::core {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostColumns = 16'384, kMostRows = 1'048'576;  // of a sheet in Excel
constexpr const char* kWorkbookPart = "xl/workbook.xml";
constexpr const char* kWholeWorkbook = "a workbook as Excel or LibreOffice saves it (.xlsx), or the sheet as CSV";

const ZipArchive::Entry* entry_of(const ZipArchive& archive, std::string_view name) {
  const auto& entries = archive.entries();
  const auto at = std::find_if(entries.begin(), entries.end(), [&](const auto& entry) { return entry.name == name; });
  return at == entries.end() ? nullptr : &*at;
}

/// Element names of a workbook may have any prefix for their namespace: "row", "x:row".
bool is_element(pugi::xml_node node, std::string_view name) {
  std::string_view whole = node.name();
  if (const auto colon = whole.find(':'); colon != std::string_view::npos) whole.remove_prefix(colon + 1);
  return whole == name;
}

std::vector<pugi::xml_node> children_of(pugi::xml_node parent, std::string_view name) {
  std::vector<pugi::xml_node> found;
  for (const pugi::xml_node child : parent.children()) {
    if (is_element(child, name)) found.push_back(child);
  }
  return found;
}

pugi::xml_node child_of(pugi::xml_node parent, std::string_view name) {
  for (const pugi::xml_node child : parent.children()) {
    if (is_element(child, name)) return child;
  }
  return {};
}

/// The characters of a string item: its text, or that of its parts of different looks, without phonetic hints.
std::string text_of_item(pugi::xml_node item) {
  std::string text;
  for (const pugi::xml_node child : item.children()) {
    if (is_element(child, "t")) text += child.text().get();
    if (is_element(child, "r")) text += child_of(child, "t").text().get();
  }
  return text;
}

/// Of one line and without tabs and quotes, which separate fields. No header is longer than kMost bytes.
std::string as_field(std::string text) {
  constexpr std::size_t kMost = 256;
  if (text.size() > kMost) {
    std::size_t size = kMost;
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xC0) == 0x80) --size;  // no character is cut in two
    text.resize(size);
  }
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '"'; }, ' ');
  return text;
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

/// Whether a number format shows a date or a time: a letter of these outside quotes, brackets and escapes.
bool shows_date(std::string_view code) {
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    if (c == '\\' || c == '_' || c == '*') {
      ++i;
    } else if (c == '"') {
      i = std::min(code.find('"', i + 1), code.size());
    } else if (c == '[') {
      const std::size_t close = std::min(code.find(']', i), code.size());
      const std::string inside = lower(code.substr(i + 1, close - i - 1));  // "h", "mm": elapsed time; or a colour
      if (!inside.empty() && inside.find_first_not_of(inside.front()) == std::string::npos &&
          std::string_view("hms").find(inside.front()) != std::string_view::npos)
        return true;
      i = close;
    } else if (std::string_view("ymdhsYMDHS").find(c) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

/// Formats without a code in the file (ECMA-376 part 1, 18.8.30), those of East Asian calendars included.
bool is_built_in_date(int format) {
  return (format >= 14 && format <= 22) || (format >= 27 && format <= 36) || (format >= 45 && format <= 47) ||
         (format >= 50 && format <= 58);
}

struct Cell {
  std::size_t column = 0;  ///< from 0 on
  std::string text;
  bool is_number = false;
  bool is_date = false;  ///< it has no text then
};

struct Row {
  std::size_t number = 0;  ///< from 1 on
  std::vector<Cell> cells;
};

struct Sheet {
  std::string name;
  std::vector<Row> rows;
  std::size_t dates = 0;  ///< cells

  std::size_t rows_of_numbers() const {
    return static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), has_numbers));
  }
  static bool has_numbers(const Row& row) {
    return std::count_if(row.cells.begin(), row.cells.end(), [](const Cell& cell) { return cell.is_number; }) > 1;
  }
};

class Workbook {
 public:
  explicit Workbook(const fs::path& file) : file_(file), archive_(file) {
    list_sheets();
    read_strings();
    read_styles();
  }

  std::size_t sheets() const { return sheets_.size(); }

  Sheet sheet(std::size_t index) {
    const auto& [name, part_name] = sheets_[index];
    const std::string xml = bytes_of(part_name);
    sheet_bytes_ += xml.size();
    if (sheet_bytes_ > kMostBytesOfSheets) {
      refuse("", fmt::format("sheets of more than {} bytes before one with a table", kMostBytesOfSheets),
             "no more than that: save the table alone as CSV");
    }
    const pugi::xml_document document = parsed(xml, part_name);
    Sheet read{name, {}};
    std::size_t last_row = 0;
    for (const pugi::xml_node row : children_of(child_of(document.document_element(), "sheetData"), "row")) {
      const std::string_view stated = row.attribute("r").value();
      const std::size_t number = stated.empty() ? last_row + 1 : whole(stated, part_name);
      if (number <= last_row || number > kMostRows) {
        refuse(part_name, fmt::format("row \"{}\" after row {}", as_field(std::string(stated)), last_row));
      }
      last_row = number;
      read.rows.push_back({number, cells_of(row, part_name, read.dates)});
    }
    return read;
  }

  [[noreturn]] void refuse(const std::string& key, std::string found, std::string expected = kWholeWorkbook) const {
    throw base::InputError(base::Issue{file_.string(), 0, key, std::move(found), std::move(expected)});
  }

 private:
  std::string bytes_of(const std::string& name) const {
    const ZipArchive::Entry* const entry = entry_of(archive_, name);
    if (entry == nullptr) refuse(name, "no such part in the workbook");
    return archive_.read(*entry, kMostPartBytes);
  }

  pugi::xml_document parsed(const std::string& xml, const std::string& name) const {
    return parse_xml(xml, fmt::format("{}: {}", file_.string(), name), kWholeWorkbook, BlankText::kept);
  }

  pugi::xml_document part(const std::string& name) const { return parsed(bytes_of(name), name); }

  static std::string id_of(pugi::xml_node sheet) {
    for (const pugi::xml_attribute attribute : sheet.attributes()) {
      if (std::string_view(attribute.name()).ends_with(":id")) return attribute.value();
    }
    return {};
  }

  /// The parts that hold worksheets, no charts or macros. Their names go into messages, so they are cleaned and short.
  std::map<std::string, std::string> worksheets_by_id() const {
    std::map<std::string, std::string> parts;
    const pugi::xml_document links = part("xl/_rels/workbook.xml.rels");
    for (const pugi::xml_node link : children_of(links.document_element(), "Relationship")) {
      if (!std::string_view(link.attribute("Type").value()).ends_with("/worksheet")) continue;
      const std::string target = link.attribute("Target").value();
      parts.emplace(link.attribute("Id").value(),
                    as_field(target.starts_with('/') ? target.substr(1) : "xl/" + target));
    }
    return parts;
  }

  void list_sheets() {
    const std::map<std::string, std::string> worksheets = worksheets_by_id();
    const pugi::xml_document book = part(kWorkbookPart);
    const std::vector<pugi::xml_node> listed = children_of(child_of(book.document_element(), "sheets"), "sheet");
    if (listed.size() > kMostSheets) {
      refuse("", fmt::format("a workbook of {} sheets", listed.size()), fmt::format("at most {}", kMostSheets));
    }
    std::set<std::string> seen;  // a damaged workbook may name one part several times
    for (const pugi::xml_node sheet : listed) {
      const auto at = worksheets.find(id_of(sheet));
      if (at == worksheets.end() || !seen.insert(at->second).second) continue;  // a chart, a macro, or seen already
      sheets_.emplace_back(as_field(sheet.attribute("name").value()), at->second);
    }
    if (sheets_.empty()) refuse("", "a workbook without a worksheet");
  }

  void read_strings() {
    if (entry_of(archive_, "xl/sharedStrings.xml") == nullptr) return;  // none are needed for numbers alone
    const pugi::xml_document strings = part("xl/sharedStrings.xml");
    for (const pugi::xml_node item : children_of(strings.document_element(), "si")) {
      strings_.push_back(as_field(text_of_item(item)));
    }
  }

  void read_styles() {
    if (entry_of(archive_, "xl/styles.xml") == nullptr) return;
    const pugi::xml_document styles = part("xl/styles.xml");
    std::set<int> own_dates, own;
    for (const pugi::xml_node format : children_of(child_of(styles.document_element(), "numFmts"), "numFmt")) {
      const int id = format.attribute("numFmtId").as_int();
      own.insert(id);
      if (shows_date(format.attribute("formatCode").value())) own_dates.insert(id);
    }
    for (const pugi::xml_node style : children_of(child_of(styles.document_element(), "cellXfs"), "xf")) {
      const int id = style.attribute("numFmtId").as_int();
      is_date_.push_back(own.contains(id) ? own_dates.contains(id) : is_built_in_date(id));
    }
  }

  std::size_t whole(std::string_view text, const std::string& part_name) const {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) {
      refuse(part_name, fmt::format("\"{}\" where a number should be", as_field(std::string(text))));
    }
    return value;
  }

  /// "AB12" is column 27; kMostColumns for anything else.
  static std::size_t column_of_name(std::string_view name) {
    std::size_t column = 0;
    for (const char c : name) {
      if (c < 'A' || c > 'Z' || column > kMostColumns) break;
      column = 26 * column + static_cast<std::size_t>(c - 'A') + 1;
    }
    return column == 0 ? kMostColumns : column - 1;
  }

  std::vector<Cell> cells_of(pugi::xml_node row, const std::string& part_name, std::size_t& dates) const {
    std::vector<Cell> cells;
    std::size_t next = 0;
    for (const pugi::xml_node node : children_of(row, "c")) {
      const std::string_view place = node.attribute("r").value();
      const std::size_t column = place.empty() ? next : column_of_name(place);
      if (column < next || column >= kMostColumns) {
        refuse(part_name, fmt::format("a cell \"{}\" out of order", as_field(std::string(place))));
      }
      next = column + 1;
      Cell cell = cell_of(node, part_name, dates);
      cell.column = column;
      if (!is_blank(cell.text) || cell.is_date) cells.push_back(std::move(cell));
    }
    return cells;
  }

  Cell cell_of(pugi::xml_node node, const std::string& part_name, std::size_t& dates) const {
    const std::string_view kind = node.attribute("t").value();
    if (kind == "inlineStr") return {0, as_field(text_of_item(child_of(node, "is")))};
    const char* const value = child_of(node, "v").text().get();
    if (kind == "e" || is_blank(value)) return {};
    if (kind == "s") {
      const std::size_t index = whole(value, part_name);
      if (index >= strings_.size()) refuse(part_name, fmt::format("text {} of {}", index, strings_.size()));
      return {0, strings_[index]};
    }
    const auto style = static_cast<std::size_t>(std::max(node.attribute("s").as_int(), 0));
    const bool is_text = kind == "str" || kind == "b";
    if (kind == "d" || (!is_text && style < is_date_.size() && is_date_[style])) {
      ++dates;
      return {0, {}, false, true};
    }
    std::string text = as_field(value);
    const bool is_number = number_in(text, '.').has_value();
    if (!is_text && !is_number) refuse(part_name, fmt::format("\"{}\" where a number should be", text));
    return {0, std::move(text), is_number};
  }

  fs::path file_;
  ZipArchive archive_;
  std::vector<std::string> strings_;
  std::vector<bool> is_date_;                                ///< of a cell's style
  std::vector<std::pair<std::string, std::string>> sheets_;  ///< name and part
  std::size_t sheet_bytes_ = 0;                              ///< unpacked so far
};

/// One line a row, at the row's number; columns before those of the numbers hold titles and are left out.
std::string text_of(const Workbook& book, const Sheet& sheet) {
  std::size_t first = kMostColumns;
  for (const Row& row : sheet.rows) {
    if (Sheet::has_numbers(row)) first = std::min(first, row.cells.front().column);
  }
  if (first == kMostColumns) first = 0;
  std::string text;
  std::size_t line = 1;
  for (const Row& row : sheet.rows) {
    text.append(row.number - line, '\n');
    line = row.number;
    std::size_t column = first;
    for (const Cell& cell : row.cells) {
      if (cell.column < first) continue;
      text.append(cell.column - column, '\t');
      column = cell.column;
      text += cell.text;
    }
    if (text.size() > kMostSheetBytes) {
      book.refuse(fmt::format("sheet \"{}\"", sheet.name), fmt::format("more than {} bytes as text", kMostSheetBytes),
                  "no more than that: save the table alone as CSV");
    }
  }
  return text;
}

}  // namespace

bool is_spreadsheet(const fs::path& file) {
  if (!is_zip_archive(first_bytes_of(file, 4))) return false;
  const ZipArchive archive(file);
  return entry_of(archive, kWorkbookPart) != nullptr || entry_of(archive, "xl/workbook.bin") != nullptr ||
         (entry_of(archive, "mimetype") != nullptr && entry_of(archive, "content.xml") != nullptr);
}

SheetText read_sheet(const fs::path& file) {
  {
    const ZipArchive archive(file);
    if (entry_of(archive, kWorkbookPart) == nullptr) {
      const bool binary = entry_of(archive, "xl/workbook.bin") != nullptr;
      throw base::InputError(base::Issue{file.string(), 0, "",
                                         binary ? "a binary workbook of Excel (.xlsb)" : "an OpenDocument file (.ods)",
                                         "a spreadsheet that is saved as CSV or .xlsx"});
    }
  }
  Workbook book(file);
  std::optional<Sheet> taken;
  for (std::size_t i = 0; i < book.sheets(); ++i) {
    Sheet sheet = book.sheet(i);
    const std::size_t rows = sheet.rows_of_numbers();
    if (rows >= kFewestSheetRows || !taken || (sheet.dates > taken->dates && taken->rows_of_numbers() == 0)) {
      taken = std::move(sheet);
    }
    if (rows >= kFewestSheetRows) break;
  }
  SheetText sheet;
  sheet.shown_as = fmt::format("{}: sheet \"{}\"", file.string(), taken->name);
  sheet.dates = taken->dates;
  if (taken->dates > 0 && taken->rows_of_numbers() == 0) {
    throw base::InputError(base::Issue{
        sheet.shown_as, 0, "", fmt::format("{} cells with dates or times of day", taken->dates), dates_expectation()});
  }
  sheet.text = text_of(book, *taken);
  if (book.sheets() > 1) sheet.sheet = taken->name;
  return sheet;
}

std::string dates_expectation() {
  return "times in seconds as plain numbers: a time of day counts days, so multiply it by 86400 and format the cells "
         "as "
         "numbers";
}

}  // namespace glidelab::core
