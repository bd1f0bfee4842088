#include "base/text/number_text.h"

#include <limits>

#include "tests/catch.h"

using namespace glidelab::base;
using namespace glidelab;

TEST_CASE("a value has the decimals of two significant digits of its sd") {
  CHECK(value_and_sd_text(2.77913, 0.0062) == "2.7791 ± 0.0062");
  CHECK(value_and_sd_text(4.3, 0.25) == "4.30 ± 0.25");
  CHECK(value_and_sd_text(1234.5, 12.3) == "1234 ± 12");
  CHECK(value_and_sd_text(0.0071234, 0.00009961) == "0.00712 ± 0.00010");  // the sd itself rounds up a digit
}

TEST_CASE("a value and its sd have no more digits than the sd supports") {
  CHECK(value_and_sd_text(0.00283, 2.04) == "0.0 ± 2.0");
  CHECK(value_and_sd_text(0.902, 0.5) == "0.90 ± 0.50");
  CHECK(value_and_sd_text(-5.0981, 0.031) == "-5.098 ± 0.031");
  CHECK(value_and_sd_text(1234.0, 56.0) == "1234 ± 56");
  CHECK(value_and_sd_text(1.5, 0.0) == "1.5 ± 0");
}

TEST_CASE("without a usable sd a value keeps six significant digits") {
  CHECK(value_text(2.768, 0.0) == "2.768");
  CHECK(value_text(1.0 / 3.0, -1.0) == "0.333333");
  CHECK(value_text(std::nan(""), 0.1) == "–");
  // The largest number there is, which rounded up is none.
  CHECK(value_text(1.0, std::numeric_limits<double>::max()) == "1");
  CHECK(sd_text(std::numeric_limits<double>::max()) == "1.8e+308");
}

TEST_CASE("a number has plain digits where they are few, and a power of ten beyond") {
  CHECK(number_text(412.3, 2) == "410");
  CHECK(number_text(0.0000181, 3) == "0.0000181");
  CHECK(number_text(-0.000018, 3) == "-0.000018");
  CHECK(number_text(0.00009996, 3) == "0.0001");  // rounds up to another power of ten
  CHECK(number_text(123456.0, 1) == "100000");
  CHECK(number_text(7.26e8, 3) == "7.26e+08");
  CHECK(number_text(3.4e-8, 2) == "3.4e-08");
  CHECK(number_text(2.5, 1) == "2");
}

TEST_CASE("an error shows its sign, and none where it rounds to zero") {
  CHECK(error_text(0.00312, 0.0041) == "+0.0031");
  CHECK(error_text(-0.00312, 0.0041) == "-0.0031");
  CHECK(error_text(-0.00001, 0.0041) == "0.0000");
  CHECK(error_text(0.0, 0.0041) == "0.0000");
  CHECK(error_text(-0.00006, 0.0041) == "-0.0001");
  CHECK(error_text(0.0031249, 0.0) == "+0.00312");  // nothing says how many digits it has
  CHECK(error_text(-2.0, std::numeric_limits<double>::infinity()) == "-2");
}

TEST_CASE("numbers of one column keep the zeros at their end") {
  CHECK(digits_text(1.1, 3) == "1.10");
  CHECK(digits_text(10.0, 3) == "10.0");
  CHECK(digits_text(500.2, 3) == "500");
  CHECK(digits_text(0.00009, 3) == "0.0000900");
  CHECK(digits_text(412.3, 2) == "410");
  CHECK(digits_text(412.3, 1) == "400");
  CHECK(digits_text(9.996, 3) == "10.0");
  CHECK(digits_text(7.2e8, 3) == "7.20e+08");
  CHECK(digits_text(0.0, 3) == "0");
  CHECK(digits_text(std::nan(""), 3) == "–");
}

TEST_CASE("a power of ten is written as by hand, and a number without one stays") {
  CHECK(with_raised_power("1.957e-05") == "1.957·10⁻⁵");
  CHECK(with_raised_power("-2e+12") == "-2·10¹²");
  CHECK(with_raised_power("0.0003") == "0.0003");
}

TEST_CASE("R² is never rounded up to 1") {
  CHECK(r2_text(0.99993) == "0.99993");
  CHECK(r2_text(0.9999999) == "0.9999999");
  CHECK(r2_text(1.0) == "1.00000");
  CHECK(r2_text(0.5) == "0.50000");
}

TEST_CASE("a gain has its sign, one decimal below a thousand and a raised power of ten from a million on") {
  CHECK(gain_text(3.24) == "+3.2");
  CHECK(gain_text(-0.44) == "-0.4");
  CHECK(gain_text(999.94) == "+999.9");
  CHECK(gain_text(139520.6) == "+139521");
  CHECK(gain_text(-1.3954e12) == "-1.395·10¹²");
  CHECK(gain_text(53249876.54321) == "+5.325·10⁷");
  CHECK(gain_text(std::nan("")) == "–");
}

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
