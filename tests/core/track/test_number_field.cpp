#include "core/track/number_field.h"

#include "tests/catch.h"

using glidelab::core::is_month_and_number;
using glidelab::core::number_in;

TEST_CASE("a field is a number with one decimal sign, and nothing else") {
  CHECK(number_in("-1.5e-2", '.') == -0.015);
  CHECK(number_in("+3", '.') == 3.0);
  CHECK(number_in("-1,70E+01", ',') == -17.0);
  CHECK_FALSE(number_in("0.5", ','));
  CHECK_FALSE(number_in("0,5", '.'));
  CHECK_FALSE(number_in("0.5 m", '.'));
  CHECK_FALSE(number_in("inf", '.'));
  CHECK_FALSE(number_in("", '.'));
}

TEST_CASE("a minus sign of its own and blanks between thousands are those of spreadsheets") {
  CHECK(number_in("\xE2\x88\x92"
                  "0,25",
                  ',') == -0.25);
  CHECK(number_in("1 234,5", ',') == 1234.5);
  CHECK(number_in("12\xC2\xA0"
                  "345\xE2\x80\xAF"
                  "678",
                  '.') == 12345678.0);
  CHECK_FALSE(number_in("1 23", '.'));    // two numbers
  CHECK_FALSE(number_in("1 2345", '.'));  // no group of three
  CHECK_FALSE(number_in("0 .5", '.'));
  CHECK_FALSE(number_in("0 123", '.'));     // no group begins with a zero
  CHECK_FALSE(number_in("1234 567", '.'));  // nor with four digits
  CHECK_FALSE(number_in("1 234", '.', glidelab::core::Thousands::without_plain_blanks));
}

TEST_CASE("a month beside a number is a date that a spreadsheet made of a number") {
  CHECK(is_month_and_number("01.jan"));
  CHECK(is_month_and_number("jan.13"));
  CHECK(is_month_and_number("1.m\xC3\xA4rz"));
  CHECK_FALSE(is_month_and_number("1.13"));
  CHECK_FALSE(is_month_and_number("jan"));
  CHECK_FALSE(is_month_and_number("x.y"));
  CHECK_FALSE(is_month_and_number("12.s"));
}
