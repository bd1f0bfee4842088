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

/// Of a word that a hyphen would join: letters of other alphabets among them.
bool joins(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.' || c == ']';
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
        html[i] == '-' && i + 1 < html.size() && is_digit(html[i + 1]) && (i == 0 || !joins(html[i - 1]));
    text += minus ? std::string_view("\u2212") : html.substr(i, 1);
    ++i;
  }
  return text;
}

}  // namespace glidelab::report
