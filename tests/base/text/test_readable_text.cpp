#include "base/text/readable_text.h"

#include <string>

#include "tests/catch.h"

using glidelab::base::trimmed;
using namespace glidelab;

TEST_CASE("text that is not UTF-8 gets a replacement for each wrong byte, and valid text stays") {
  for (const char* valid : {"", "plain", "ung\u00FCltig", "\u20AC \U0001F600", "\u0800\uD7FF\uE000\uFFFF"}) {
    CHECK(base::valid_utf8(valid) == valid);
    CHECK(base::is_utf8(valid));
  }
  for (const char* wrong : {"ung\xFCltig", "a\x80z", "\xE2\x82", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80"})
    CHECK_FALSE(base::is_utf8(wrong));
  CHECK(base::valid_utf8("ung\xFCltig") == "ung\uFFFDltig");                  // Latin-1
  CHECK(base::valid_utf8("a\x80z") == "a\uFFFDz");                            // a continuation without a beginning
  CHECK(base::valid_utf8("\xE2\x82") == "\uFFFD\uFFFD");                      // cut off
  CHECK(base::valid_utf8("\xC0\xAF") == "\uFFFD\uFFFD");                      // overlong
  CHECK(base::valid_utf8("\xED\xA0\x80") == "\uFFFD\uFFFD\uFFFD");            // a surrogate
  CHECK(base::valid_utf8("\xF4\x90\x80\x80") == "\uFFFD\uFFFD\uFFFD\uFFFD");  // beyond U+10FFFF
}

TEST_CASE("control characters of both sets are replaced, and characters of other languages are not") {
  CHECK(base::printable_text("a\x1b[31mb\x7f") == "a?[31mb?");
  CHECK(base::printable_text("a\u0085\u009Bb\u00A0c") == "a??b\u00A0c");  // next line, control sequence; a hard blank
  CHECK(base::printable_text("\x9B\u00B5") == "\uFFFD\u00B5");
}

TEST_CASE("a text is cut between two characters") {
  CHECK(base::first_bytes("abc", 3) == "abc");
  CHECK(base::first_bytes("abcd", 3) == "abc");
  CHECK(base::first_bytes("ab\u20AC", 4) == "ab");  // the third character has three bytes
  CHECK(base::first_bytes("ab\u20AC", 5) == "ab\u20AC");
  CHECK(base::first_bytes("\u20AC", 2).empty());
}

TEST_CASE("blanks at the ends of a text are left out, and those inside stay") {
  CHECK(trimmed(" \t a b\r") == "a b");
  CHECK(trimmed("a") == "a");
  CHECK(trimmed("").empty());
  CHECK(trimmed(" \t\r").empty());
  CHECK(trimmed("\ta ", " ") == "\ta");  // of the blanks that are named alone
}
