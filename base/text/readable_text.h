/// Text of other programs and of files: without the blanks at its ends, and made fit for a message, a file and a
/// terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glidelab::base {

/// The part of `text` between the first and the last character that is none of `blanks`; empty if there is none.
inline std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r") {
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The text with U+FFFD for each byte that is not part of well-formed UTF-8 (Unicode 15, table 3-7).
std::string valid_utf8(std::string_view text);

/// The same with "?" for each control character, those of C1 included: it must not steer the terminal.
std::string printable_text(std::string_view text);

/// Whether all of it is well-formed UTF-8.
bool is_utf8(std::string_view text);

/// At most so many bytes of well-formed UTF-8, cut between two characters.
std::string first_bytes(std::string_view text, std::size_t most);

}  // namespace glidelab::base
