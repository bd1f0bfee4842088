#include "validate/study/sweep/sweep_summary.h"

#include <fmt/format.h>

#include <vector>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("Reasons that differ in their numbers alone are one kind, and the commonest kind comes first") {
  validate::FailureKinds kinds;
  kinds.add("the lens has no model");
  for (int i = 0; i < 3; ++i) kinds.add(fmt::format("no root between {} and {}", 1e-5 / (3.0 + i), -7.0 + i));
  for (int i = 0; i < 2; ++i) kinds.add("clip \"up\" has 1 point");
  const std::vector<validate::FailureKind> found = kinds.by_number();
  REQUIRE(found.size() == 3);
  CHECK(found[0].runs == 3);
  CHECK_FALSE(found[0].one_text);
  CHECK(found[0].example == "no root between 3.3333333333333337e-06 and -7");  // the first that came
  CHECK(found[1].runs == 2);
  CHECK(found[1].one_text);
  CHECK(found[2].runs == 1);
}

TEST_CASE("A number is taken out with its sign and power, and a hyphen or an e of a word stays") {
  CHECK(validate::without_numbers("between -1.5e-05 and 2E+3, (0.5)") == "between # and #, (#)");
  CHECK(validate::without_numbers("clip-2: 12 eggs, 3e, a 4.") == "clip-#: # eggs, #e, a #.");
  CHECK(validate::without_numbers("1-2") == "#-#");
  CHECK(validate::without_numbers("").empty());
}

TEST_CASE("A number with more than six digits is rounded to four, and whole, short and worded ones stay") {
  CHECK(validate::with_rounded_numbers("no root between 1.5811388300841898e-05 and 0.33333333333333331") ==
        "no root between 0.00001581 and 0.3333");
  CHECK(validate::with_rounded_numbers("-2.7182818284 s") == "-2.718 s");
  CHECK(validate::with_rounded_numbers("seed 12345678901234, 9.80665 and 0.000012 at 120 Hz") ==
        "seed 12345678901234, 9.80665 and 0.000012 at 120 Hz");
}
