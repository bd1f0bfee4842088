#include "report/html/typeset_numbers.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace glidelab::report {
namespace {

constexpr std::array<std::string_view, 3> kVerbatim = {"code", "script", "style"};
constexpr std::string_view kNoBreak = "\u00a0", kPlusMinus = " ± ";
constexpr std::array<std::string_view, 36> kUnits = {
    "%",     "°",     "m",   "mm",  "µm",   "nm",   "s",   "ms",    "µs",    "ns",  "kg",   "g",
    "N",     "mN",    "µN",  "Hz",  "px",   "px²",  "ppm", "EUR",   "DN",    "m/s", "mm/s", "m/s²",
    "mm/s²", "µm/s²", "1/s", "1/m", "1/m²", "kg/m", "N/m", "N s/m", "DN/e⁻", "e⁻",  "e⁻/s", "px/s"};

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

/// Of a longer word: the first byte of what could go on a unit.
bool goes_on(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalnum(byte) != 0 || byte >= 0x80u || c == '/' || c == '_' || c == '-';
}

/// The unit behind the space at `at`, without the space; "" where there is none.
std::string_view unit_behind(std::string_view html, std::size_t at) {
  const std::string_view rest = html.substr(at + 1);
  std::string_view longest;
  for (const std::string_view unit : kUnits) {
    const bool whole = rest.starts_with(unit) && (rest.size() == unit.size() || !goes_on(rest[unit.size()]));
    if (whole && unit.size() > longest.size()) longest = unit;
  }
  return longest;
}

/// How many bytes from the space at `at` on belong to the number before it; 0 where a line may begin there.
std::size_t joined_behind(std::string_view html, std::size_t at) {
  if (html[at] != ' ' || at == 0) return 0;
  if (is_digit(html[at - 1]) && html.substr(at).starts_with(kPlusMinus)) return kPlusMinus.size();
  const std::string_view unit = is_digit(html[at - 1]) || html[at - 1] == ')' ? unit_behind(html, at) : "";
  return unit.empty() ? 0 : 1 + unit.size();
}

}  // namespace

std::string typeset_numbers(std::string_view html) {
  std::string text;
  text.reserve(html.size());
  for (std::size_t i = 0; i < html.size();) {
    if (html[i] == '<') {
      const std::size_t end = end_of_markup(html, i);
      text += html.substr(i, end - i);
      i = end;
      continue;
    }
    if (const std::size_t joined = joined_behind(html, i); joined > 0) {
      for (const char c : html.substr(i, joined)) text += c == ' ' ? kNoBreak : std::string_view(&c, 1);
      i += joined;
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
