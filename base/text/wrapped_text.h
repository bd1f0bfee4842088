/// Text for a terminal: lines of limited width, counted in characters of UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace glidelab::base {

/// Characters in a line of a terminal as it opens.
inline constexpr std::size_t kTerminalWidth = 80;

/// The number of code points.
std::size_t characters_in(std::string_view text);

/// The text with line breaks between words, so that no line has more than `width` characters unless a single word has.
/// Every line that is begun here, and not by a break of the text itself, starts with `indent` spaces, which count.
/// Spaces at the beginning of a line stay; between words one is left. A number keeps to its ±.
std::string wrapped(std::string_view text, std::size_t width, std::size_t indent = 0);

/// The same for printed results: only what is longer than `width`, and not lines of tables, whose columns are two
/// spaces apart.
std::string prose_wrapped(std::string_view text, std::size_t width);

}  // namespace glidelab::base
