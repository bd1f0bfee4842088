#include "base/text/wrapped_text.h"

#include <string>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("a text is broken between words, at the width in characters, not in bytes") {
  // "µ µ µ µ" has 7 characters and 11 bytes.
  CHECK(base::characters_in("µ µ µ µ") == 7);
  CHECK(base::wrapped("µ µ µ µ", 7) == "µ µ µ µ");
  CHECK(base::wrapped("µ µ µ µ", 6) == "µ µ µ\nµ");
  CHECK(base::wrapped("one two three", 7) == "one two\nthree");
}

TEST_CASE("a word that is wider than a line has one of its own") {
  CHECK(base::wrapped("a incomprehensible b", 5) == "a\nincomprehensible\nb");
}

TEST_CASE("a number and its uncertainty stay on one line") {
  CHECK(base::wrapped("mu = 0.0146 ± 0.0042 to 0.0105 ± 0.0041", 24) == "mu = 0.0146 ± 0.0042 to\n0.0105 ± 0.0041");
  CHECK(base::wrapped("mu = 0.0146 ± 0.0042", 15) == "mu =\n0.0146 ± 0.0042");
  CHECK(base::wrapped("a ± ", 2) == "a ± ");
}

TEST_CASE("lines that are begun are indented, and breaks and indents of the text itself stay") {
  CHECK(base::wrapped("one two\n  three four", 7, 2) == "one two\n  three\n  four");
  CHECK(base::wrapped("", 5).empty());
  CHECK(base::wrapped("one\n\ntwo\n", 5) == "one\n\ntwo\n");
}

TEST_CASE("of printed results only sentences are wrapped, not the rows of a table") {
  const std::string table = "quantity   truth   recovered\nK/m        2.768       2.767\n";
  CHECK(base::prose_wrapped("The law fits these clips.\n\n" + table, 20) == "The law fits these\nclips.\n\n" + table);
}
