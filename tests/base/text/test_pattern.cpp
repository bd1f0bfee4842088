#include "base/text/pattern.h"

#include "tests/catch.h"

using namespace glidelab::base;

TEST_CASE("a pattern finds what does not overlap, from left to right, with its groups") {
  const Pattern pattern("([a-z]+)=([0-9]+)?");
  CHECK(pattern.matches("mu=3, k=; m=12") ==
        std::vector<Captured>{{"mu=3", "mu", "3"}, {"k=", "k", ""}, {"m=12", "m", "12"}});
  CHECK(pattern.matches("no sign of equality").empty());
}

TEST_CASE("an anchored pattern matches whole texts alone") {
  const Pattern pattern("^[0-9]+$");
  CHECK(pattern.matches("335") == std::vector<Captured>{{"335"}});
  CHECK(pattern.matches("335 g").empty());
}

TEST_CASE("every match is replaced and the text between them stays") {
  const Pattern pattern("\\{([a-z]+)\\}");
  const auto in_brackets = [](const Captured& part) { return "<" + part[1] + ">"; };
  CHECK(pattern.replaced("{a} and {bc}.", in_brackets) == "<a> and <bc>.");
  CHECK(pattern.replaced("no place", in_brackets) == "no place");
  CHECK(pattern.replaced("", in_brackets).empty());
}
