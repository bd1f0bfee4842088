#include "base/nearest_word.h"

#include "catch.h"

using glidelab::base::nearest_word;

TEST_CASE("A word with one letter put in, left out, replaced or two swapped finds the word that was meant") {
  const std::vector<std::string> known = {"simulate", "render", "analyze", "laws"};
  CHECK(nearest_word("simmulate", known) == "simulate");
  CHECK(nearest_word("rendr", known) == "render");
  CHECK(nearest_word("analyse", known) == "analyze");
  CHECK(nearest_word("lwas", known) == "laws");
  CHECK(nearest_word("analyze", known) == "analyze");
}

TEST_CASE("A word that is like none of the known ones finds nothing") {
  CHECK(nearest_word("bandwidth", {"simulate", "render"}).empty());
  CHECK(nearest_word("bandwidth", {}).empty());
}
