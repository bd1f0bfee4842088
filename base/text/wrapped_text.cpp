#include "base/text/wrapped_text.h"

#include <algorithm>

namespace glidelab::base {
namespace {

/// Where the word that begins at `at` ends; "2.4 ± 0.1" is one.
std::size_t end_of_word(std::string_view line, std::size_t at) {
  constexpr std::string_view kPlusMinus = " ± ";
  std::size_t end = std::min(line.find(' ', at), line.size());
  while (line.substr(end).starts_with(kPlusMinus)) end = std::min(line.find(' ', end + kPlusMinus.size()), line.size());
  return end;
}

/// One line, without a break at its end.
std::string wrapped_line(std::string_view line, std::size_t width, std::size_t indent) {
  std::size_t at = std::min(line.find_first_not_of(' '), line.size());
  std::string text(line.substr(0, at));
  std::size_t used = at;
  bool begun = false;  // whether the current line has a word
  while (at < line.size()) {
    const std::size_t end = end_of_word(line, at);
    const std::string_view word = line.substr(at, end - at);
    const std::size_t length = characters_in(word);
    if (begun && used + 1 + length > width) {
      text += "\n" + std::string(indent, ' ');
      used = indent;
      begun = false;
    }
    if (begun) text += ' ';
    text += word;
    used += length + (begun ? 1 : 0);
    begun = true;
    at = std::min(line.find_first_not_of(' ', end), line.size());
  }
  return text;
}

/// Each line of the text as `change` makes it.
template <typename Change>
std::string line_by_line(std::string_view text, const Change& change) {
  std::string all;
  while (true) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    all += change(text.substr(0, end));
    if (end == text.size()) return all;
    all += '\n';
    text.remove_prefix(end + 1);
  }
}

bool is_of_table(std::string_view line) {
  return line.find("  ", std::min(line.find_first_not_of(' '), line.size())) != std::string_view::npos;
}

}  // namespace

std::size_t characters_in(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }));
}

std::string wrapped(std::string_view text, std::size_t width, std::size_t indent) {
  return line_by_line(text, [&](std::string_view line) { return wrapped_line(line, width, indent); });
}

std::string prose_wrapped(std::string_view text, std::size_t width) {
  return line_by_line(text, [&](std::string_view line) {
    const bool stays = characters_in(line) <= width || is_of_table(line);
    return stays ? std::string(line) : wrapped_line(line, width, 0);
  });
}

}  // namespace glidelab::base
