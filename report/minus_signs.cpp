#include "report/minus_signs.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace glidelab::report {
namespace {

constexpr std::array<std::string_view, 3> kVerbatim = {"code", "script", "style"};

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The character that ends before `at` (above 0) in UTF-8.
char32_t character_before(std::string_view text, std::size_t at) {
  char32_t value = 0;
  unsigned shift = 0;
  do {
    const auto byte = static_cast<unsigned char>(text[--at]);
    const bool continues = (byte & 0xC0u) == 0x80u;
    const unsigned bits = continues      ? 0x3Fu
                          : byte < 0x80u ? 0x7Fu
                          : byte < 0xE0u ? 0x1Fu
                          : byte < 0xF0u ? 0x0Fu
                                         : 0x07u;
    value |= static_cast<char32_t>(byte & bits) << shift;
    if (!continues) break;
    shift += 6;
  } while (at > 0 && shift < 24);
  return value;
}

/// Of a word that a hyphen would join, letters of other alphabets among them: those lie from U+00C0 on but for the
/// signs × and ÷ and the block of punctuation and mathematical signs, U+2000 to U+2BFF.
bool joins(char32_t c) {
  if (c < 0x80) return std::isalnum(static_cast<int>(c)) != 0 || c == '-' || c == '_' || c == '.' || c == ']';
  return c == U'µ' || (c >= 0xC0 && c != U'×' && c != U'÷' && (c < 0x2000 || c >= 0x2C00));
}

bool opens(std::string_view tag, std::string_view name) {
  return tag.starts_with(name) &&
         (tag.size() == name.size() || !std::isalnum(static_cast<unsigned char>(tag[name.size()])));
}

/// Where what is not text, and begins at the "<" at `at`, ends: behind the tag, or behind the element that is verbatim.
std::size_t end_of_markup(std::string_view html, std::size_t at) {
  const std::size_t behind = std::min(html.find('>', at), html.size() - 1) + 1;
  const std::string_view tag = html.substr(at + 1, behind - at - 2);
  for (const std::string_view name : kVerbatim) {
    if (opens(tag, name)) return std::min(html.find("</" + std::string(name), behind), html.size());
  }
  return behind;
}

}  // namespace

std::string with_minus_signs(std::string_view html) {
  std::string text;
  text.reserve(html.size());
  for (std::size_t i = 0; i < html.size();) {
    if (html[i] == '<') {
      const std::size_t end = end_of_markup(html, i);
      text += html.substr(i, end - i);
      i = end;
      continue;
    }
    const bool minus =
        html[i] == '-' && i + 1 < html.size() && is_digit(html[i + 1]) && (i == 0 || !joins(character_before(html, i)));
    text += minus ? std::string_view("\u2212") : html.substr(i, 1);
    ++i;
  }
  return text;
}

}  // namespace glidelab::report
