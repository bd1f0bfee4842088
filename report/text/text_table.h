/// A table for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace glidelab::report {

/// The text with "?" for each control character: a clip's name must not steer the terminal.
std::string printable(std::string text);

/// Columns set under their headers, two spaces apart; columns from `first_number` on are flush right. Widths count
/// characters, not bytes. printable() is applied to every cell.
std::string text_table(const std::vector<std::vector<std::string>>& rows, std::size_t first_number);

}  // namespace glidelab::report
