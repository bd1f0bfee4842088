#include "base/text/trimmed.h"

#include "tests/catch.h"

using glidelab::base::trimmed;

TEST_CASE("blanks at the ends of a text are left out, and those inside stay") {
  CHECK(trimmed(" \t a b\r") == "a b");
  CHECK(trimmed("a") == "a");
  CHECK(trimmed("").empty());
  CHECK(trimmed(" \t\r").empty());
  CHECK(trimmed("\ta ", " ") == "\ta");  // of the blanks that are named alone
}
