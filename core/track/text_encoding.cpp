#include "core/track/text_encoding.h"

#include <algorithm>
#include <cstddef>

#include "base/text/readable_text.h"

namespace glidelab::core {
namespace {

void append_utf8(char32_t code, std::string& text) {
  const auto byte = [&](char32_t value) { text += static_cast<char>(static_cast<unsigned char>(value)); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | (code >> 6));
    byte(0x80 | (code & 0x3F));
  } else {
    byte(0xE0 | (code >> 12));
    byte(0x80 | ((code >> 6) & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

unsigned char byte_at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

/// Of the basic plane; a surrogate is written as a question mark, for no number or name of a column needs one.
std::string from_utf16(std::string_view bytes, bool little_endian) {
  std::string text;
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const unsigned first = byte_at(bytes, i), second = byte_at(bytes, i + 1);
    const char32_t code = little_endian ? first | (second << 8) : (first << 8) | second;
    append_utf8(code >= 0xD800 && code < 0xE000 ? U'?' : code, text);
  }
  return text;
}

}  // namespace

std::string as_utf8(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes, true);
  if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes, false);
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (base::is_utf8(bytes)) return std::string(bytes);
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) append_utf8(byte_at(bytes, i), text);
  return text;
}

NoTable no_table_in(std::string_view bytes) {
  if (bytes.starts_with("\xD0\xCF\x11\xE0")) {
    return {"an Excel file (.xls)",
            "a workbook that is saved as .xlsx without a password, or text: save the sheet as CSV"};
  }
  if (bytes.starts_with("\x93NUMPY")) return {"an array of numpy (.npy)", "text: numpy.savetxt writes it"};
  if (bytes.starts_with("MATLAB ") && bytes.substr(0, 40).find("MAT-file") != std::string_view::npos)
    return {"a file of MATLAB (.mat)", "text: writematrix writes it"};
  // MP4 and QuickTime, AVI, Matroska and WebM.
  const bool is_video = bytes.substr(0, 12).substr(std::min<std::size_t>(4, bytes.size())).starts_with("ftyp") ||
                        (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("AVI ")) ||
                        bytes.starts_with("\x1A\x45\xDF\xA3");
  if (is_video) {
    return {"a video", "a table of times and positions; a video goes into a folder, which glidelab new FOLDER makes"};
  }
  constexpr std::string_view kBlank = " \t\r\n";
  const auto first = bytes.find_first_not_of(kBlank);
  if (first == std::string_view::npos || (bytes[first] != '{' && bytes[first] != '[')) return {};
  // "[Run 1]" is the title of a table.
  const auto inside = bytes.find_first_not_of(kBlank, first + 1);
  constexpr std::string_view kBegins = "\"{[-0123456789";
  if (inside != std::string_view::npos && kBegins.find(bytes[inside]) != std::string_view::npos &&
      bytes.find('"') != std::string_view::npos) {
    return {"JSON", "a table: write the times and the positions as two columns, with the header t,x"};
  }
  return {};
}

}  // namespace glidelab::core
