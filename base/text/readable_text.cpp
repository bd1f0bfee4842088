#include "base/text/readable_text.h"

#include <algorithm>

namespace glidelab::base {
namespace {

unsigned char byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

bool continues_character(unsigned char byte) {
  return (byte & 0xC0) == 0x80;
}

/// Number of bytes of the well-formed character that begins at `at`; 0 if none does.
std::size_t character_length(std::string_view text, std::size_t at) {
  const unsigned char lead = byte_at(text, at);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead <= 0xDF   ? 2
                             : lead >= 0xE0 && lead <= 0xEF ? 3
                             : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                            : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!continues_character(byte_at(text, at + i))) return 0;
  }
  const unsigned char second = byte_at(text, at + 1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second > 0x9F, beyond = lead == 0xF4 && second > 0x8F;
  return overlong || surrogate || beyond ? 0 : length;
}

bool is_control(std::string_view character) {
  const unsigned char first = byte_at(character, 0);
  return first < 0x20 || first == 0x7F || (first == 0xC2 && byte_at(character, 1) < 0xA0);
}

template <typename Put>
std::string each_character(std::string_view text, const Put& put) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    if (length == 0) {
      result += "\uFFFD";
    } else {
      result += put(text.substr(at, length));
    }
    at += std::max<std::size_t>(1, length);
  }
  return result;
}

}  // namespace

std::string valid_utf8(std::string_view text) {
  return each_character(text, [](std::string_view character) { return character; });
}

std::string printable_text(std::string_view text) {
  return each_character(
      text, [](std::string_view character) { return is_control(character) ? std::string_view("?") : character; });
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

std::string first_bytes(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && continues_character(byte_at(text, most))) --most;
  return std::string(text.substr(0, most));
}

}  // namespace glidelab::base
