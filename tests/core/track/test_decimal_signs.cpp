/// Tables in which one column has decimal commas and another decimal points, as a recorder and a spreadsheet make them
/// together.
#include <fmt/format.h>

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "core/track/number_field.h"
#include "core/track/track_data.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// `head`, and ten lines of the pattern; {0} is the number, {1} its square with two digits.
core::TrackData read(const std::string& head, const std::string& pattern) {
  const tests::TempDir folder;
  std::ofstream out(folder / "export.csv");
  out << head;
  for (int i = 0; i < 10; ++i) out << fmt::format(fmt::runtime(pattern), i, fmt::format("{:02d}", i * i));
  out.close();
  return core::read_track_csv(folder / "export.csv", 1);
}

/// t = 0.1 i, x = 0.01 i².
void check_motion(const core::TrackData& track) {
  REQUIRE(track.t_s.size() == 10);
  for (std::size_t i = 0; i < 10; ++i) {
    const auto n = static_cast<double>(i);
    CHECK(track.t_s[i] == Approx(0.1 * n).margin(1e-12));
    CHECK(track.x_m[i] == Approx(0.01 * n * n).margin(1e-12));
  }
}

}  // namespace

TEST_CASE("between semicolons or tabs each column may have a decimal sign of its own") {
  check_motion(read("t (s);x (m);v (m/s)\n", "0,{0};0.{1};0,00E+00\n"));
  check_motion(read("t (s);x (m);v (m/s)\n", "0.{0};0,{1}E+00;43513,00\n"));
  check_motion(read("t (s)\tx (m)\tn\n", "0,{0}\t0.{1}\t{0}\n"));
  // Three digits after each point, but a zero before it, which divides no thousands.
  check_motion(read("t (s);x (m)\n", "0,{0};0.{1}0\n"));
  // A missing value says nothing of the sign.
  CHECK(read("t (s);x (m)\n0,95;\n1,05;0.5\n", "1,{0}9;0.{1}\n").t_s.size() == 11);
}

TEST_CASE("where three digits follow each sign, decimals and thousands cannot be told apart") {
  CHECK_THROWS_WITH(read("t (s);x (m)\n", "0.{0};1,2{1}\n"),
                    Contains("column \"x (m)\"") && Contains("such as 1,281") && Contains("between thousands"));
  CHECK_THROWS_WITH(read("t (s);x (m)\n", "0,{0};1.2{1}\n"), Contains("such as 1.281") && Contains("decimal point"));
  // One column alone in the file has a sign: as ever, it is the decimal one.
  CHECK(read("t (s);x (m)\n", "{0};1,2{1}\n").x_m[9] == Approx(1.281));
}

TEST_CASE("a column with both signs, and both signs where blanks are between columns, are refused") {
  CHECK_THROWS_WITH(read("t (s);x (m)\n0.01;0,5\n", "0,{0};0.{1}\n"), Contains("do not go together in one column"));
  CHECK_THROWS_WITH(read("t x\n", "0,{0} 0.{1}\n"), Contains("semicolons or tabs"));
  // One wrong field in a file of decimal points is that field's fault.
  CHECK_THROWS_WITH(read("t (s);x (m)\n0.001;0.0\n0.002;0,5\n", "0.{0}5;0.{1}\n"),
                    Contains("\"0,5\"") && Contains("decimal point"));
}

TEST_CASE("a sign with three digits after it may divide thousands, unless a zero stands before it") {
  const auto may_be = [](const std::vector<std::string_view>& fields) {
    core::DecimalSign sign;
    for (const std::string_view field : fields) sign.see(field);
    return sign.may_be_thousands();
  };
  CHECK(may_be({"1,234", "43513,000"}));
  CHECK(may_be({"-1.234", "17"}));
  CHECK_FALSE(may_be({"1,234", "0,149"}));
  CHECK_FALSE(may_be({"1,234", "1,5"}));
  CHECK_FALSE(may_be({"1,234E+00"}));
  CHECK_FALSE(may_be({"17", "18"}));
}
