#include "base/text/number_text.h"

#include <limits>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("a size comes in the unit that leaves it a readable number") {
  CHECK(base::size_text(-0.00033, 2, "m") == "-0.33 mm");
  CHECK(base::size_text(0.094, 2, "N s/m") == "0.094 N s/m");
  CHECK(base::size_text(0.5, 2, "m") == "0.5 m");
  CHECK(base::size_text(2.5e-7, 2, "s") == "0.25 µs");
  CHECK(base::size_text(-1e-12, 2, "N") == "-0.001 nN");  // there is nothing below
}

TEST_CASE("a size and its standard deviation have one unit, that of the larger") {
  CHECK(base::size_and_sd_text(0.0123, 0.0012, "m") == "12.3 ± 1.2 mm");
  CHECK(base::size_and_sd_text(1e-6, 0.5, "m") == "0.00 ± 0.50 m");
  CHECK(base::size_and_sd_text(0.25, 0.0, "") == "0.25");
  CHECK(base::size_and_sd_text(0.0025, 0.0, "m") == "2.5 mm");
  CHECK(base::size_and_sd_text(0.25, std::numeric_limits<double>::infinity(), "m") == "0.25 m");
}
