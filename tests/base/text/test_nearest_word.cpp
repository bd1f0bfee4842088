#include "base/text/nearest_word.h"

#include "tests/catch.h"

using glidelab::base::nearest_word;

TEST_CASE("A word with one letter put in, left out, replaced or two swapped finds the word that was meant") {
  const std::vector<std::string> known = {"simulate", "render", "analyze", "laws"};
  CHECK(nearest_word("simmulate", known) == "simulate");
  CHECK(nearest_word("rendr", known) == "render");
  CHECK(nearest_word("analyse", known) == "analyze");
  CHECK(nearest_word("lwas", known) == "laws");
  CHECK(nearest_word("gvc", {"cv", "gcv"}) == "gcv");  // one change, two neighbours, against two
  CHECK(nearest_word("analyze", known) == "analyze");
}

TEST_CASE("A word that is like none of the known ones finds nothing") {
  CHECK(nearest_word("bandwidth", {"simulate", "render"}).empty());
  CHECK(nearest_word("bandwidth", {}).empty());
}

TEST_CASE(
    "Words of another length count as many changes as letters are too many or missing, and the first of equals is "
    "taken") {
  CHECK(nearest_word("ab", {"abcde", "abcd"}) == "abcd");
  CHECK(nearest_word("abcd", {"a", "ab"}) == "ab");
  CHECK(nearest_word("ab", {"abcde"}).empty());
  CHECK(nearest_word("gain", {"gaim", "gait", "gainer"}) == "gaim");
  CHECK(nearest_word("exposure_second", {"exposure", "exposure_s"}) ==
        "exposure_s");  // 15 letters: five changes at most
}

TEST_CASE("The beginning of a single known word suggests it, and that of several does not") {
  CHECK(nearest_word("alpha", {"mu", "alpha_deg", "k_over_m_1_s"}) == "alpha_deg");
  CHECK(nearest_word("estimator", {"estimator_seconds", "estimator_command"}).empty());
  CHECK(nearest_word("k_", {"k_over_m_1_s"}).empty());
}
