/// The text of a table, whatever encoding a program or a spreadsheet gave it.
#pragma once

#include <string>
#include <string_view>

namespace glidelab::core {

/// UTF-8 without a byte-order mark. UTF-16 is recognised by its mark (a spreadsheet's "Unicode text"); bytes that are
/// no UTF-8 are taken as Latin-1, in which spreadsheets of Western Europe write "Posición" and "µm". Any other text,
/// also one with zero bytes, is left as it is.
std::string as_utf8(std::string_view bytes);

/// What a file is that holds no table in text, and what to do with it: "an Excel file (.xls)". Both are empty for text.
struct NoTable {
  std::string what, advice;
};
NoTable no_table_in(std::string_view bytes);

}  // namespace glidelab::core
